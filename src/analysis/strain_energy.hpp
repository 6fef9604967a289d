// Strain energy of mode shapes.
#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

#include "samara/system/periodic_system.hpp"

namespace samara::analysis {

/// Mean strain energy of a group over the instants of a shape, as the shape is scaled.
double mean_strain_energy(const system::EnergyGroup& group, const Eigen::MatrixXcd& shape);

/// Mean strain energy by the name of the motion that it restores.
std::map<std::string, double> strain_energies(const system::PeriodicSystem& system,
                                              const Eigen::MatrixXcd& shape);

}  // namespace samara::analysis
