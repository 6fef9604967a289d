// The group /geometry of a result, and the motions of its nodes in modes (docs/case_file.md,
// "Results").
#pragma once

#include <string>
#include <vector>

#include "samara/analysis/mode.hpp"
#include "samara/turbine/turbine_geometry.hpp"

#include "hdf5_file.hpp"

namespace samara::io {

/// A state of the turbine.
struct TurbineInstant {
  double time = 0.0;  ///< [s]
  Eigen::VectorXd z;
};

/// /geometry. `axis`: of the states, "instant" or "state".
void write_geometry(Hdf5File& file, const turbine::TurbineSystem& system,
                    const std::vector<TurbineInstant>& instants, const std::string& axis);

/// `group`/node_motion, for the modes with shapes that are not of a medium; the instants are those
/// of the shapes.
void write_node_motions(Hdf5File& file, const std::string& group,
                        const turbine::TurbineSystem& system, const analysis::ModeSet& set,
                        const std::vector<TurbineInstant>& instants);

}  // namespace samara::io
