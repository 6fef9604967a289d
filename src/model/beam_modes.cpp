#include "samara/model/beam_modes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "samara/base/error.hpp"
#include "samara/base/index.hpp"
#include "samara/math/rotation.hpp"

namespace samara::model {
namespace {

/// Strains of a direction: bending and its shear, or torsion.
constexpr std::array<std::array<int, 2>, 3> strains{{{4, 2}, {5, 1}, {3, 3}}};
constexpr std::array<const char*, 3> words{"bending about b2", "bending about b3", "torsion"};

/// Relative difference up to which frequencies count as equal.
constexpr double same_frequency = 1e-6;

/// A negative mu that is smaller than this fraction of the largest one is round-off.
constexpr double mu_round_off = 1e-9;

/// Rigid motions of the points (and of the masses behind them) as functions of the elastic strains.
class Kinematics {
 public:
  explicit Kinematics(const Beam& beam) : beam_(beam), points_(beam.point_count()) {
    for (int p = 0; p < points_; ++p)
      for (int i = 0; i < 6; ++i)
        if (beam.points[at(p)].compliance(i, i) > 0.0) coordinates_.emplace_back(p, i);
    // The root is clamped here, with any support.
    std::copy_if(beam.mass_nodes.begin(), beam.mass_nodes.end(), std::back_inserter(masses_),
                 [](const MassNode& node) { return node.end > 0; });
    place_nodes();
    find_motion();
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(coordinates_.size()); }
  /// Point and strain component of a coordinate, which is a section load.
  const std::vector<std::pair<int, int>>& coordinates() const { return coordinates_; }

  /// M of the kinetic energy eta_dot^T M eta_dot / 2.
  Eigen::MatrixXd mass() const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size(), size());
    const auto add = [&](int place, const Matrix3& C, const Matrix6& mass, double length) {
      Eigen::MatrixXd v(6, size());
      v.topRows<3>() = C.transpose() * u_.middleRows(3 * place, 3);
      v.bottomRows<3>() = C.transpose() * theta_.middleRows(3 * place, 3);
      sum += length * v.transpose() * mass * v;
    };
    for (int p = 0; p < points_; ++p)
      add(p, beam_.points[at(p)].C_ab, beam_.points[at(p)].mass, beam_.point_length(p));
    for (std::size_t m = 0; m < masses_.size(); ++m)
      add(points_ + 1 + static_cast<int>(m), Matrix3::Identity(), masses_[m].mass, 1.0);
    add(points_, Matrix3::Identity(), beam_.tip_mass, 1.0);
    return 0.5 * (sum + sum.transpose());
  }

 private:
  /// Places: the points, the tip, the masses. The balances of the nodes give one row for each
  /// point, and one more at the end and behind each mass.
  void place_nodes() {
    const int places = points_ + 1 + static_cast<int>(masses_.size());
    value_ = Eigen::MatrixXd::Zero(places, places);
    slope_ = Eigen::MatrixXd::Zero(places, points_);
    int row = 0;
    std::size_t mass = 0;
    for (int e = 0; e < beam_.elements; ++e) {
      if (e > 0 && mass < masses_.size() && masses_[mass].end == e) {
        const int place = points_ + 1 + static_cast<int>(mass++);
        value_(row, place) += 1.0;  // the end of one part
        value_(++row, place) -= 1.0;
      }
      for (int j = 0; j < beam_.order; ++j) {
        const int p = e * beam_.order + j;
        const double w = beam_.functions.weights[at(j)];
        for (int a = 0; a <= beam_.order; ++a) {
          value_(row + a, p) -= w * beam_.functions.slope[at(a)][at(j)];
          slope_(row + a, p) += w * beam_.element_length(e) * beam_.functions.value[at(a)][at(j)];
        }
      }
      row += beam_.order;
    }
    value_(row, points_) += 1.0;  // the tip
  }

  /// theta' = kappa, u' = theta x t + gamma, components in a.
  void find_motion() {
    const Eigen::MatrixXd integral = Eigen::PartialPivLU<Eigen::MatrixXd>(value_).solve(slope_);
    const Eigen::Index places = integral.rows();
    Eigen::MatrixXd kappa = Eigen::MatrixXd::Zero(3 * points_, size());
    Eigen::MatrixXd stretch = Eigen::MatrixXd::Zero(3 * points_, size());
    for (Eigen::Index k = 0; k < size(); ++k) {
      const auto [p, i] = coordinates_[static_cast<std::size_t>(k)];
      const elements::BeamPoint& point = beam_.points[at(p)];
      const Vector6 strain = point.compliance.col(i);
      stretch.col(k).segment<3>(3 * p) = point.C_ab * strain.head<3>();
      kappa.col(k).segment<3>(3 * p) = point.C_ab * strain.tail<3>();
    }
    const auto integrate = [&](const Eigen::MatrixXd& rate) {
      Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * places, size());
      for (Eigen::Index n = 0; n < places; ++n)
        for (int p = 0; p < points_; ++p)
          result.middleRows(3 * n, 3) += integral(n, p) * rate.middleRows(3 * p, 3);
      return result;
    };
    theta_ = integrate(kappa);
    for (int p = 0; p < points_; ++p)
      stretch.middleRows(3 * p, 3) -= math::skew<double>(Vector3(beam_.points[at(p)].C_ab.col(0))) *
                                      theta_.middleRows(3 * p, 3);
    u_ = integrate(stretch);
  }

  const Beam& beam_;
  std::vector<MassNode> masses_;
  int points_ = 0;
  std::vector<std::pair<int, int>> coordinates_;
  Eigen::MatrixXd value_, slope_;  ///< the nodes' balances: value x u = slope x u'
  Eigen::MatrixXd u_, theta_;      ///< motions of the places, one column per coordinate
};

/// Strain energy eta^T E eta / 2 of one strain component (-1: all): f_i (C f)_i at every point.
Eigen::MatrixXd strain_energy(const Beam& beam, const Kinematics& kinematics, int component) {
  const auto& coordinates = kinematics.coordinates();
  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(kinematics.size(), kinematics.size());
  for (std::size_t k = 0; k < coordinates.size(); ++k)
    for (std::size_t l = 0; l < coordinates.size(); ++l) {
      const auto [p, i] = coordinates[k];
      const auto [q, j] = coordinates[l];
      if (p != q) continue;
      const double part =
          beam.point_length(p) * beam.points[static_cast<std::size_t>(p)].compliance(i, j);
      const double weight =
          component < 0 ? 1.0 : 0.5 * ((i == component ? 1.0 : 0.0) + (j == component ? 1.0 : 0.0));
      energy(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) = weight * part;
    }
  return energy;
}

double direction_share(const Vector6& share, std::size_t direction) {
  const auto [first, second] = strains[direction];
  return share(first) + (first != second ? share(second) : 0.0);
}

}  // namespace

std::vector<BeamMode> compute_beam_modes(const Beam& beam) {
  const Kinematics kinematics(beam);
  const Eigen::Index n = kinematics.size();
  if (n == 0) return {};
  // M eta = E eta / omega^2: slow modes have large eigenvalues. After scaling of its rows E has no
  // small eigenvalues.
  const Eigen::MatrixXd E = strain_energy(beam, kinematics, -1);
  const Eigen::VectorXd scale = E.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      scale.asDiagonal() * kinematics.mass() * scale.asDiagonal(),
      scale.asDiagonal() * E * scale.asDiagonal());
  Eigen::MatrixXd shapes = scale.asDiagonal() * solver.eigenvectors().rowwise().reverse();
  const Eigen::VectorXd values = solver.eigenvalues().reverse();
  std::array<Eigen::MatrixXd, 6> energies;
  for (int i = 0; i < 6; ++i)
    energies[static_cast<std::size_t>(i)] = strain_energy(beam, kinematics, i);
  std::vector<BeamMode> modes;
  for (Eigen::Index first = 0; first < n;) {
    if (!(values(first) > 0.0)) break;
    Eigen::Index count = 1;
    while (first + count < n && values(first + count) > (1.0 - same_frequency) * values(first))
      ++count;
    // At a double frequency every combination is a mode. The combinations that diagonalize the
    // strain energy of bending about b2 are chosen.
    const Eigen::MatrixXd own = shapes.middleCols(first, count);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> turn(own.transpose() *
                                                              (energies[4] + energies[2]) * own);
    shapes.middleCols(first, count) = own * turn.eigenvectors().rowwise().reverse();
    for (Eigen::Index k = first; k < first + count; ++k) {
      BeamMode mode;
      mode.frequency = 1.0 / std::sqrt(values(k));
      for (int i = 0; i < 6; ++i)
        mode.share(i) = shapes.col(k).dot(energies[static_cast<std::size_t>(i)] * shapes.col(k));
      mode.share /= mode.share.sum();
      for (std::size_t d = 1; d < strains.size(); ++d)
        if (direction_share(mode.share, d) >
            direction_share(mode.share, static_cast<std::size_t>(mode.direction)))
          mode.direction = static_cast<int>(d);
      modes.push_back(mode);
    }
    first += count;
  }
  return modes;
}

std::array<std::vector<BeamMode>, 3> first_modes(const Beam& beam) {
  std::array<std::vector<BeamMode>, 3> result;
  for (const BeamMode& mode : compute_beam_modes(beam)) {
    std::vector<BeamMode>& own = result[static_cast<std::size_t>(mode.direction)];
    if (own.size() < 2 && mode.share(0) < 0.5) own.push_back(mode);
  }
  return result;
}

bool is_rigid(const Beam& beam, const std::array<int, 2>& of_direction) {
  for (const elements::BeamPoint& point : beam.points)
    for (const int strain : of_direction)
      if (point.compliance(strain, strain) > 0.0) return false;
  return true;
}

Vector6 fit_damping(const Beam& beam, const ModalDamping& ratios) {
  const std::array<std::vector<BeamMode>, 3> modes = first_modes(beam);
  std::vector<std::size_t> given;
  for (std::size_t d = 0; d < ratios.size(); ++d) {
    if (!ratios[d]) continue;
    if (modes[d].empty())
      throw InputError(std::string("the beam has no mode of ") + words[d] +
                       (is_rigid(beam, strains[d])
                            ? ": its strain is rigid; hint: leave this ratio out"
                            : ": other strains have the larger share of every mode; hint: leave "
                              "this ratio out, or increase elements"));
    given.push_back(d);
  }
  const auto n = static_cast<Eigen::Index>(given.size());
  Eigen::MatrixXd by_mu(n, n);
  Eigen::VectorXd wanted(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const BeamMode& mode = modes[given[static_cast<std::size_t>(i)]].front();
    wanted(i) = *ratios[given[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < n; ++j)
      by_mu(i, j) =
          0.5 * mode.frequency * direction_share(mode.share, given[static_cast<std::size_t>(j)]);
  }
  Vector6 mu = Vector6::Zero();
  if (n == 0) return mu;
  const Eigen::VectorXd found = by_mu.partialPivLu().solve(wanted);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t d = given[static_cast<std::size_t>(i)];
    if (found(i) < -mu_round_off * found.cwiseAbs().maxCoeff() || !std::isfinite(found(i)))
      throw InputError(std::string("these ratios require a negative damping of ") + words[d] +
                       ": its first mode has strains of the others and more damping "
                       "already; hint: leave this ratio out, or give mu per strain");
    for (const int strain : strains[d]) mu(strain) = std::max(found(i), 0.0);
  }
  return mu;
}

}  // namespace samara::model
