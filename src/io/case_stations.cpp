#include "case_stations.hpp"

#include "yaml_lists.hpp"

namespace samara::io {

void read_stations(MapReader& map, const model::TurbineDefinition& turbine,
                   turbine::ChannelStations& stations) {
  const auto read = [&map](std::string_view key, bool has_beam, const std::string& missing,
                           std::vector<double>& places) {
    read_numbers(map, key, fraction_of_one, places, "fractions of the length");
    if (!has_beam && !places.empty()) map.refuse(*map.node().find(key), key, missing);
  };
  read("blade_stations", turbine.blades.count > 0, "there are no blades; hint: tower_stations",
       stations.blade);
  read("tower_stations", turbine.has_tower, "there is no tower; hint: blade_stations",
       stations.tower);
}

}  // namespace samara::io
