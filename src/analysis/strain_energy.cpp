#include "strain_energy.hpp"

#include <complex>

#include "samara/analysis/identification.hpp"

namespace samara::analysis {
namespace {

using system::EnergyGroup;

Eigen::MatrixXd weight_of(const EnergyGroup& group) {
  const auto n = static_cast<Eigen::Index>(group.unknowns.size());
  return Eigen::Map<const Eigen::MatrixXd>(group.weight.data(), n, n);
}

}  // namespace

double mean_strain_energy(const EnergyGroup& group, const Eigen::MatrixXcd& shape) {
  const Eigen::MatrixXd weight = weight_of(group);
  double energy = 0.0;
  for (Eigen::Index a = 0; a < weight.rows(); ++a)
    for (Eigen::Index b = 0; b < weight.cols(); ++b) {
      if (weight(a, b) == 0.0) continue;
      const auto row = group.unknowns[static_cast<std::size_t>(a)];
      const auto column = group.unknowns[static_cast<std::size_t>(b)];
      energy += 0.5 * weight(a, b) * std::real(shape.row(row).dot(shape.row(column)));
    }
  return energy / static_cast<double>(shape.cols());
}

double strain_energy_of(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape) {
  double energy = 0.0;
  for (const EnergyGroup& group : system.energy_groups())
    if (group.kind == EnergyGroup::Kind::strain) energy += mean_strain_energy(group, shape);
  return energy;
}

std::map<std::string, double> strain_energies(const system::PeriodicSystem& system,
                                              const Eigen::MatrixXcd& shape) {
  std::map<std::string, double> strain;
  for (const EnergyGroup& group : system.energy_groups())
    if (group.kind == EnergyGroup::Kind::strain)
      strain[motion_name(group)] += mean_strain_energy(group, shape);
  return strain;
}

}  // namespace samara::analysis
