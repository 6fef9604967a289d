#include "samara/analysis/identification.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace samara::analysis {
namespace {

using system::EnergyGroup;

/// Share of the energy that must be strain for a mode to be called elastic.
constexpr double elastic_share = 0.15;

/// Relative distance of two exponents that do not split.
constexpr double degenerate = 1e-8;

/// Correlation of two blades beyond which they move alike or opposite.
constexpr double clear_correlation = 0.8;

Eigen::MatrixXd weight_of(const EnergyGroup& group) {
  const auto n = static_cast<Eigen::Index>(group.unknowns.size());
  return Eigen::Map<const Eigen::MatrixXd>(group.weight.data(), n, n);
}

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

/// Correlation of the strains of one motion in blades 1 and 2: 1 alike, -1 opposite.
double blade_correlation(const std::vector<EnergyGroup>& groups, const std::string& motion,
                         const Eigen::MatrixXcd& shape) {
  std::vector<const EnergyGroup*> first;
  std::vector<const EnergyGroup*> second;
  for (const EnergyGroup& group : groups) {
    if (group.kind != EnergyGroup::Kind::strain || group.motion != motion) continue;
    if (group.blade == 1) first.push_back(&group);
    if (group.blade == 2) second.push_back(&group);
  }
  double both = 0.0;
  double one = 0.0;
  double other = 0.0;
  for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
    const Eigen::RowVectorXcd a = shape.row(first[i]->unknowns[0]);
    const Eigen::RowVectorXcd b = shape.row(second[i]->unknowns[0]);
    both += first[i]->weight[0] * std::real(a.dot(b));
    one += first[i]->weight[0] * a.squaredNorm();
    other += first[i]->weight[0] * b.squaredNorm();
  }
  const double size = std::sqrt(one * other);
  return size > 0.0 ? both / size : 0.0;
}

/// The joint that turns most: the free position of the largest mean square.
std::string moving_joint(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape) {
  std::string name;
  double largest = 0.0;
  for (std::size_t i = 0; i < system.rows().size(); ++i) {
    const system::Unknown& unknown = system.unknowns()[i];
    const bool joint = unknown.name.ends_with(" angle");
    const double size = shape.row(static_cast<Eigen::Index>(i)).squaredNorm();
    const bool support = unknown.name.find(" support theta") != std::string::npos;
    if (!(joint || support) || size <= largest) continue;
    largest = size;
    const std::string beam = unknown.name.substr(0, unknown.name.find(' '));
    if (joint)
      name = unknown.name.substr(0, unknown.name.size() - std::string(" angle").size());
    else if (unknown.is_free)
      name = beam + " hinge";
    else
      name = beam == "tower" ? "foundation" : beam + " support";
  }
  return name;
}

/// A stem without what it says of the blades' symmetry.
std::string without_symmetry(const std::string& stem) {
  for (const std::string& ending : {std::string(" antisymmetric"), std::string(" symmetric")})
    if (stem.ends_with(ending)) return stem.substr(0, stem.size() - ending.size());
  return stem;
}

/// Modes of equal exponents mix at will: they are symmetric or antisymmetric only where they split.
/// Over a blade passage they do: half a revolution gives one the opposite sign, another harmonic.
void unite_degenerate(const ModeSet& set, std::vector<std::string>& stems) {
  for (std::size_t i = 0; i < stems.size(); ++i)
    for (std::size_t j = i + 1; j < stems.size(); ++j) {
      const std::complex<double> a = set.modes[i].exponent;
      if (a == 0.0 || std::abs(a - set.modes[j].exponent) > degenerate * std::abs(a)) continue;
      if (set.modes[i].harmonic != set.modes[j].harmonic) continue;
      const std::string common = without_symmetry(stems[i]);
      if (common != without_symmetry(stems[j])) continue;
      stems[i] = stems[j] = common;
    }
}

/// Mean strain energy by "part/motion".
std::map<std::string, double> strain_energies(const system::PeriodicSystem& system,
                                              const Eigen::MatrixXcd& shape) {
  std::map<std::string, double> strain;
  for (const EnergyGroup& group : system.energy_groups())
    if (group.kind == EnergyGroup::Kind::strain)
      strain[group.part + "/" + group.motion] += mean_strain_energy(group, shape);
  return strain;
}

std::string stem_of(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                    const Mode& mode) {
  const std::map<std::string, double> strain = strain_energies(system, shape);
  const auto largest_entry =
      std::max_element(strain.begin(), strain.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  const std::string joint = moving_joint(system, shape);
  if (mode.resolved && !joint.empty() && is_rigid_body(system, shape, mode)) return joint;
  if (largest_entry == strain.end()) return joint.empty() ? "mode" : joint;
  const std::string& largest = largest_entry->first;
  int blades = 0;
  for (const EnergyGroup& group : system.energy_groups()) blades = std::max(blades, group.blade);
  const std::string part = largest.substr(0, largest.find('/'));
  const std::string motion = largest.substr(largest.find('/') + 1);
  if (part == "joint" || part == "support") return motion;
  if (part != "blade" || blades != 2) return part + " " + motion;
  const double alike = blade_correlation(system.energy_groups(), motion, shape);
  if (alike > clear_correlation) return "blade " + motion + " symmetric";
  if (alike < -clear_correlation) return "blade " + motion + " antisymmetric";
  return "blade " + motion;
}

}  // namespace

bool is_rigid_body(const system::PeriodicSystem& system, const Eigen::MatrixXcd& shape,
                   const Mode& mode) {
  double strained = 0.0;
  for (const EnergyGroup& group : system.energy_groups())
    if (group.kind == EnergyGroup::Kind::strain && group.part != "joint")
      strained +=
          (1.0 + group.damping * std::abs(mode.exponent)) * mean_strain_energy(group, shape);
  return strained < elastic_share * (strained + mode.kinetic_energy);
}

double sorting_frequency(std::complex<double> exponent, double rotor_speed) {
  const double slow = rotor_speed > 0.0 ? rotor_speed : 1.0;
  return exponent.imag() == 0.0 && std::abs(exponent) < slow ? 0.0 : std::abs(exponent);
}

void scale_shapes(const system::PeriodicSystem& system, ModeSet& set) {
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    Eigen::MatrixXcd& shape = set.shapes[m];
    double largest = 0.0;
    for (Eigen::Index i = 0; i < shape.rows(); ++i)
      if (system.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::position)
        largest = std::max(largest, shape.row(i).cwiseAbs().maxCoeff());
    if (!(largest > 0.0)) continue;
    shape /= largest;
    set.modes[m].kinetic_energy /= largest * largest;
  }
}

void label_modes(const system::PeriodicSystem& system, ModeSet& set) {
  std::map<std::string, int> count;
  std::vector<std::string> stems;
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  for (std::size_t i = 0; i < set.shapes.size(); ++i) {
    const std::string joint = moving_joint(system, set.shapes[i]);
    const bool rests = std::abs(set.modes[i].exponent) < zero && !joint.empty();
    stems.push_back(rests ? joint : stem_of(system, set.shapes[i], set.modes[i]));
  }
  unite_degenerate(set, stems);
  for (const std::string& stem : stems) ++count[stem];
  std::map<std::string, int> number;
  // Modes beyond the step's reach come anywhere among the others, and do not use up their numbers.
  for (const bool resolved : {true, false})
    for (std::size_t i = 0; i < stems.size(); ++i) {
      if (set.modes[i].resolved != resolved) continue;
      const std::string& stem = stems[i];
      set.modes[i].label = count[stem] > 1 ? stem + " " + std::to_string(++number[stem]) : stem;
    }
}

}  // namespace samara::analysis
