// Places along the beams whose loads and motions are channels.
#pragma once

#include "samara/model/definition.hpp"
#include "samara/turbine/turbine_channels.hpp"

#include "yaml_reader.hpp"

namespace samara::io {

/// Reads `blade_stations` and `tower_stations`; `turbine` has been read.
void read_stations(MapReader& map, const model::TurbineDefinition& turbine,
                   turbine::ChannelStations& stations);

}  // namespace samara::io
