#include "samara/analysis/mode_tracking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "samara/base/error.hpp"
#include "samara/math/assignment.hpp"

#include "shape_series.hpp"

namespace samara::analysis {
namespace {

using Index = Eigen::Index;
using Complex = std::complex<double>;
using system::EnergyGroup;

/// Harmonics of a shape relative to its exponent. The shape of a mode of given exponent changes
/// slowly over the azimuth, so that a few are enough to recognize it.
constexpr int most_harmonics = 8;
constexpr int azimuths = 16;
/// Harmonics between the copies of one mode at neighbouring points.
constexpr int most_shift = 6;
/// Energy of a motion without energy, relative to the square of its largest unknown.
constexpr double no_energy = 1e-20;
/// Relative to the squares of the shapes (1): singular values of the basis of all shapes below its
/// root belong to shapes that coincide. Shapes have the digits of single precision.
constexpr double ridge = 1e-6;
/// Points before the last one from which lost lines may go on.
constexpr std::size_t most_earlier = 4;
/// A later copy, or the conjugate, must be more alike by this factor than an earlier one: for real
/// exponents several are equal.
constexpr double clearly = 1.001;
/// Largest difference between the exponents of a mode at neighbouring points, relative to the
/// larger modulus, and relative to the difference of the rotor speeds.
constexpr double most_change = 0.5;
constexpr double most_change_by_speed = 2.0;
/// Relative difference of exponents that are the same: their modes may mix.
constexpr double same_exponent = 1e-4;

/// Signals by the numbers of the unknowns: energies of the same unknowns add up, and an energy that
/// one of two systems lacks (a spring without stiffness) is a row of zeros.
class EnergySignals {
 public:
  explicit EnergySignals(const system::PeriodicSystem& system)
      : size_(system.size()), first_(static_cast<std::size_t>(system.size())) {
    std::iota(first_.begin(), first_.end(), 0);
    for (const EnergyGroup& group : system.energy_groups())
      for (const PetscInt unknown : group.unknowns)
        first_[find(unknown)] = find(group.unknowns.front());
    std::map<std::size_t, std::vector<PetscInt>> joined;
    std::vector<bool> has_energy(first_.size(), false);
    for (const EnergyGroup& group : system.energy_groups())
      for (const PetscInt unknown : group.unknowns)
        has_energy[static_cast<std::size_t>(unknown)] = true;
    for (std::size_t i = 0; i < first_.size(); ++i)
      if (has_energy[i]) joined[find(static_cast<PetscInt>(i))].push_back(static_cast<PetscInt>(i));
    std::map<std::size_t, Eigen::MatrixXd> weights;
    for (const auto& [root, unknowns] : joined) {
      const auto n = static_cast<Index>(unknowns.size());
      weights[root] = Eigen::MatrixXd::Zero(n, n);
    }
    for (const EnergyGroup& group : system.energy_groups()) {
      if (group.unknowns.empty()) continue;
      const std::size_t root = find(group.unknowns.front());
      const auto n = static_cast<Index>(group.unknowns.size());
      std::vector<Index> places;
      for (const PetscInt unknown : group.unknowns)
        places.push_back(std::ranges::lower_bound(joined[root], unknown) - joined[root].begin());
      weights[root](places, places) += Eigen::Map<const Eigen::MatrixXd>(group.weight.data(), n, n);
    }
    for (const auto& [root, unknowns] : joined)
      parts_.push_back({unknowns, symmetric_root(weights[root])});
  }

  /// Signals of columns of all unknowns.
  Eigen::MatrixXcd of(const Eigen::MatrixXcd& shape) const {
    Eigen::MatrixXcd signals = Eigen::MatrixXcd::Zero(size_, shape.cols());
    for (const Part& part : parts_)
      signals(part.unknowns, Eigen::all) = part.root * shape(part.unknowns, Eigen::all);
    return signals;
  }

 private:
  /// Unknowns whose energies are coupled.
  struct Part {
    std::vector<PetscInt> unknowns;
    Eigen::MatrixXd root;
  };

  std::size_t find(PetscInt unknown) {
    auto i = static_cast<std::size_t>(unknown);
    while (first_[i] != i) i = first_[i] = first_[first_[i]];
    return i;
  }

  /// Unlike a root by pivoting, it changes little when the weight changes little.
  static Eigen::MatrixXd symmetric_root(const Eigen::MatrixXd& weight) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(weight);
    const Eigen::MatrixXd& vectors = solver.eigenvectors();
    return vectors * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
           vectors.transpose();
  }

  Index size_;
  std::vector<std::size_t> first_;  ///< of each unknown: another one that is coupled with it
  std::vector<Part> parts_;
};

/// Real and imaginary parts of all shapes at an azimuth: signals x (2 modes).
Eigen::MatrixXd shapes_at(const ModeSignatures& signatures, double azimuth) {
  const auto count = static_cast<Index>(signatures.shapes.size());
  if (count == 0) return {};
  Eigen::MatrixXd basis(signatures.shapes.front().rows(), 2 * count);
  for (Index m = 0; m < count; ++m) {
    const Eigen::MatrixXcf& shape = signatures.shapes[static_cast<std::size_t>(m)];
    const Index harmonics = shape.cols() / 2;
    Eigen::VectorXcf wave(shape.cols());
    for (Index k = 0; k < shape.cols(); ++k)
      wave(k) = std::complex<float>(std::polar(1.0, static_cast<double>(k - harmonics) * azimuth));
    const Eigen::VectorXcf values = shape * wave;
    basis.col(m) = values.real().cast<double>();
    basis.col(count + m) = values.imag().cast<double>();
  }
  return basis;
}

/// Products of the left eigenvectors of one set with the shapes u of another one and with their
/// conjugates, at one azimuth. Left eigenvectors are dual to all shapes and conjugates of their
/// own set. `gram`: R^T R of their real basis R; `cross`: R^T times the real basis of the others.
struct Products {
  Eigen::MatrixXcd with_shapes;
  Eigen::MatrixXcd with_conjugates;

  Products(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& cross) {
    const Index own = gram.rows() / 2;
    const Index others = cross.cols() / 2;
    Eigen::MatrixXd regular = gram;
    regular.diagonal().array() += ridge;
    const Eigen::MatrixXd dual = regular.llt().solve(cross);
    const auto a_re = dual.topLeftCorner(own, others);
    const auto a_im = dual.topRightCorner(own, others);
    const auto b_re = dual.bottomLeftCorner(own, others);
    const auto b_im = dual.bottomRightCorner(own, others);
    // l = (a - i b)/2 with the rows a, b that are dual to Re u and Im u: l u = 1, l conj(u) = 0.
    with_shapes.resize(own, others);
    with_shapes.real() = 0.5 * (a_re + b_im);
    with_shapes.imag() = 0.5 * (a_im - b_re);
    with_conjugates.resize(own, others);
    with_conjugates.real() = 0.5 * (a_re - b_im);
    with_conjugates.imag() = -0.5 * (a_im + b_re);
  }
};

/// Sums over the azimuth for one shift, for the shapes and for their conjugates: from x to.
using SumsOfShift = std::array<Eigen::MatrixXcd, 2>;

/// The likeness of each pair of modes, from x to, with the copy in which they are most alike.
struct Likeness {
  Eigen::MatrixXd values;
  Eigen::MatrixXi shifts;
  Eigen::MatrixXi conjugates;  ///< 1: with the conjugate
};

std::vector<int> shifts_between(const ModeSignatures& from, const ModeSignatures& to) {
  std::vector<int> shifts{0};
  if (from.rotor_speed == 0.0 || to.rotor_speed == 0.0) return shifts;
  for (int s = 1; s <= most_shift; ++s) {
    shifts.push_back(s);
    shifts.push_back(-s);
  }
  return shifts;
}

/// With u_to = a u_from exp(i s psi) the products of the left eigenvectors are l_from u_to =
/// a exp(i s psi) and l_to u_from = exp(-i s psi)/a; with u_to = a conj(u_from) exp(i s psi) they
/// are l_from conj(u_to) = conj(a) exp(-i s psi) and l_to conj(u_from) = exp(-i s psi)/a.
Likeness find_likeness(const ModeSignatures& from, const ModeSignatures& to) {
  const std::vector<int> shifts = shifts_between(from, to);
  const int instants = shifts.size() > 1 ? azimuths : 1;
  const auto rows = static_cast<Index>(from.shapes.size());
  const auto columns = static_cast<Index>(to.shapes.size());
  Eigen::VectorXcd own_from = Eigen::VectorXcd::Zero(rows);
  Eigen::VectorXcd own_to = Eigen::VectorXcd::Zero(columns);
  const Eigen::MatrixXcd zero = Eigen::MatrixXcd::Zero(rows, columns);
  std::vector<SumsOfShift> forward(shifts.size(), {zero, zero});
  std::vector<SumsOfShift> backward(shifts.size(), {zero, zero});
  for (int n = 0; n < instants; ++n) {
    const double azimuth = 2.0 * std::numbers::pi * n / instants;
    const Eigen::MatrixXd basis_from = shapes_at(from, azimuth);
    const Eigen::MatrixXd basis_to = shapes_at(to, azimuth);
    const Eigen::MatrixXd gram_from = basis_from.transpose() * basis_from;
    const Eigen::MatrixXd gram_to = basis_to.transpose() * basis_to;
    const Eigen::MatrixXd cross = basis_from.transpose() * basis_to;
    own_from += Products(gram_from, gram_from).with_shapes.diagonal();
    own_to += Products(gram_to, gram_to).with_shapes.diagonal();
    const Products of_from(gram_from, cross);
    const Products of_to(gram_to, cross.transpose());
    for (std::size_t i = 0; i < shifts.size(); ++i) {
      const Complex turn = std::polar(1.0, shifts[i] * azimuth);
      forward[i][0] += std::conj(turn) * of_from.with_shapes;
      forward[i][1] += turn * of_from.with_conjugates;
      backward[i][0] += turn * of_to.with_shapes.transpose();
      backward[i][1] += turn * of_to.with_conjugates.transpose();
    }
  }
  const Eigen::MatrixXd own = (own_from.cwiseAbs() * own_to.cwiseAbs().transpose());
  Likeness result;
  result.values = Eigen::MatrixXd::Zero(rows, columns);
  result.shifts = Eigen::MatrixXi::Zero(rows, columns);
  result.conjugates = Eigen::MatrixXi::Zero(rows, columns);
  for (std::size_t i = 0; i < shifts.size(); ++i)
    for (const std::size_t c : {0U, 1U}) {
      const Eigen::MatrixXd values =
          forward[i][c].cwiseAbs().cwiseProduct(backward[i][c].cwiseAbs());
      for (Index m = 0; m < rows; ++m)
        for (Index n = 0; n < columns; ++n) {
          const double value = own(m, n) > 0.0 ? values(m, n) / own(m, n) : 0.0;
          if (value <= clearly * result.values(m, n)) continue;
          result.values(m, n) = value;
          result.shifts(m, n) = shifts[i];
          result.conjugates(m, n) = static_cast<int>(c);
        }
    }
  return result;
}

/// Shift of the copy at the end of a link, from that at its start.
int shift_after(int shift_before, bool is_conjugate_after, int shift) {
  return shift_before + (is_conjugate_after ? -shift : shift);
}

/// Exponent of mode n of `to` in the copy that is most like mode m of `from`.
Complex copy_of(const ModeSignatures& to, const Likeness& likeness, Index m, Index n) {
  const bool is_conjugate = likeness.conjugates(m, n) != 0;
  return tracked_exponent(to.exponents[static_cast<std::size_t>(n)],
                          {0, 0, is_conjugate, shift_after(0, is_conjugate, likeness.shifts(m, n))},
                          to.rotor_speed);
}

/// A mode does not become another one whose exponent is far away, whatever its shape.
void leave_out_far_exponents(const ModeSignatures& from, const ModeSignatures& to,
                             Likeness& likeness) {
  const double by_speed = most_change_by_speed * std::abs(to.rotor_speed - from.rotor_speed);
  for (Index m = 0; m < likeness.values.rows(); ++m)
    for (Index n = 0; n < likeness.values.cols(); ++n) {
      const Complex before = from.exponents[static_cast<std::size_t>(m)];
      const Complex after = copy_of(to, likeness, m, n);
      if (std::abs(after - before) >
          most_change * std::max(std::abs(after), std::abs(before)) + by_speed)
        likeness.values(m, n) = 0.0;
    }
}

bool is_wanted(const std::vector<bool>& wanted, std::size_t mode) {
  return wanted.empty() || wanted[mode];
}

/// True for equal multipliers: exponents that differ by multiples of i Omega, or one of them and
/// the conjugate of the other.
bool has_same_multiplier(Complex a, Complex b, double rotor_speed) {
  const double size = same_exponent * std::max(std::abs(a), std::abs(b));
  if (std::abs(a.real() - b.real()) > size) return false;
  return std::ranges::any_of(std::array{a.imag() - b.imag(), a.imag() + b.imag()}, [&](double x) {
    return std::abs(rotor_speed > 0.0 ? std::remainder(x, rotor_speed) : x) <= size;
  });
}

/// Likeness of a pair together with those of other modes that have the same multiplier as one of
/// it: these modes mix arbitrarily.
double shared_likeness(const ModeSignatures& from, const ModeSignatures& to,
                       const Likeness& likeness, Index m, Index n) {
  double of_to = 0.0;
  for (Index b = 0; b < likeness.values.cols(); ++b)
    if (b == n || has_same_multiplier(to.exponents[static_cast<std::size_t>(b)],
                                      to.exponents[static_cast<std::size_t>(n)], to.rotor_speed))
      of_to += likeness.values(m, b);
  double of_from = 0.0;
  for (Index a = 0; a < likeness.values.rows(); ++a)
    if (a == m ||
        has_same_multiplier(from.exponents[static_cast<std::size_t>(a)],
                            from.exponents[static_cast<std::size_t>(m)], from.rotor_speed))
      of_from += likeness.values(a, n);
  return std::min(1.0, std::max(of_to, of_from));
}

}  // namespace

ModeSignatures find_signatures(const system::PeriodicSystem& system, const ModeSet& set) {
  const EnergySignals energy_signals(system);
  const int harmonics =
      set.rotor_speed > 0.0 ? harmonics_of_samples(set.shape_times.size(), most_harmonics) : 0;
  const Eigen::MatrixXcd fit = harmonics_fit(set.shape_times, set.rotor_speed, harmonics);
  const double zero = zero_exponent * (set.rotor_speed > 0.0 ? set.rotor_speed : 1.0);
  ModeSignatures result;
  result.rotor_speed = set.rotor_speed;
  for (std::size_t m = 0; m < set.shapes.size(); ++m) {
    const Mode& mode = set.modes[m];
    if (!mode.resolved || is_of_medium(mode) || set.shapes[m].size() == 0 ||
        std::abs(mode.exponent) < zero)
      continue;
    const Eigen::MatrixXcd shape = centred_shape(set, m);
    const double largest = shape.cwiseAbs().maxCoeff();
    Eigen::MatrixXcd signals = energy_signals.of(shape) * fit;
    const double energy = signals.squaredNorm();
    if (!(energy > no_energy * largest * largest)) continue;
    result.modes.push_back(m);
    result.exponents.push_back(mode.exponent);
    result.shapes.emplace_back((signals / std::sqrt(energy)).cast<std::complex<float>>());
  }
  return result;
}

std::vector<ModeLink> link_modes(const ModeSignatures& from, const ModeSignatures& to,
                                 const std::vector<bool>& wanted_from,
                                 const std::vector<bool>& wanted_to) {
  if (from.shapes.empty() || to.shapes.empty()) return {};
  if (from.shapes.front().rows() != to.shapes.front().rows())
    throw InputError("modes of different meshes cannot be compared: " +
                     std::to_string(from.shapes.front().rows()) + " and " +
                     std::to_string(to.shapes.front().rows()) +
                     " unknowns; hint: a sweep keeps the parts and the elements");
  Likeness likeness = find_likeness(from, to);
  leave_out_far_exponents(from, to, likeness);
  std::vector<Index> rows;
  for (std::size_t m = 0; m < from.modes.size(); ++m)
    if (is_wanted(wanted_from, m)) rows.push_back(static_cast<Index>(m));
  std::vector<Index> columns;
  for (std::size_t n = 0; n < to.modes.size(); ++n)
    if (is_wanted(wanted_to, n)) columns.push_back(static_cast<Index>(n));
  const std::vector<int> column_of = math::find_best_assignment(likeness.values(rows, columns));
  std::vector<ModeLink> links;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (column_of[i] < 0) continue;
    const Index m = rows[i];
    const Index n = columns[static_cast<std::size_t>(column_of[i])];
    links.push_back({static_cast<std::size_t>(m), static_cast<std::size_t>(n),
                     likeness.conjugates(m, n) != 0, likeness.shifts(m, n),
                     shared_likeness(from, to, likeness, m, n)});
  }
  return links;
}

std::complex<double> tracked_exponent(std::complex<double> exponent, const TrackedMode& tracked,
                                      double rotor_speed) {
  return (tracked.is_conjugate ? std::conj(exponent) : exponent) +
         Complex(0.0, tracked.shift * rotor_speed);
}

double tracked_damping(std::complex<double> exponent, const TrackedMode& tracked,
                       double rotor_speed) {
  const Complex own = tracked_exponent(exponent, tracked, rotor_speed);
  return own == 0.0 ? 0.0 : -own.real() / std::abs(own);
}

void ModeTracker::add(std::size_t point, ModeSignatures next) {
  constexpr std::size_t none = ~std::size_t{0};
  Point added{point, std::move(next), {}};
  added.line_of.assign(added.signatures.modes.size(), none);
  for (std::size_t back = 0; back < before_.size(); ++back) {
    const Point& before = before_[before_.size() - 1 - back];
    const std::vector<bool> wanted_from = ends_at(before);
    std::vector<bool> wanted_to;
    for (const std::size_t line : added.line_of) wanted_to.push_back(line == none);
    const auto is_true = [](bool wanted) { return wanted; };
    if (std::ranges::none_of(wanted_from, is_true) || std::ranges::none_of(wanted_to, is_true))
      continue;
    extend(before, added, link_modes(before.signatures, added.signatures, wanted_from, wanted_to));
  }
  for (std::size_t m = 0; m < added.line_of.size(); ++m) {
    if (added.line_of[m] != none) continue;
    added.line_of[m] = lines_.size();
    lines_.push_back({TrackedMode{point, added.signatures.modes[m]}});
  }
  std::erase_if(before_, [this](const Point& earlier) {
    const std::vector<bool> ends = ends_at(earlier);
    return std::ranges::none_of(ends, [](bool is_end) { return is_end; });
  });
  if (before_.size() > most_earlier) before_.erase(before_.begin());
  before_.push_back(std::move(added));
}

std::vector<bool> ModeTracker::ends_at(const Point& point) const {
  std::vector<bool> ends;
  for (const std::size_t line : point.line_of)
    ends.push_back(lines_[line].back().point == point.number);
  return ends;
}

void ModeTracker::extend(const Point& before, Point& next, const std::vector<ModeLink>& links) {
  for (const ModeLink& link : links) {
    if (link.likeness < least_likeness) continue;
    const std::size_t line = before.line_of[link.from];
    const TrackedMode& end = lines_[line].back();
    TrackedMode tracked{next.number, next.signatures.modes[link.to],
                        end.is_conjugate != link.is_conjugate, 0, link.likeness};
    tracked.shift = shift_after(end.shift, tracked.is_conjugate, link.shift);
    next.line_of[link.to] = line;
    lines_[line].push_back(tracked);
  }
}

std::vector<std::vector<TrackedMode>> ModeTracker::lines() const {
  std::vector<std::vector<TrackedMode>> result = lines_;
  for (std::vector<TrackedMode>& line : result) {
    std::map<std::pair<bool, int>, int> copies;
    for (const TrackedMode& mode : line) ++copies[{mode.is_conjugate, mode.shift}];
    const auto [conjugate, shift] =
        std::ranges::max_element(copies, {}, [](const auto& copy) { return copy.second; })->first;
    // The inverse of the most frequent transformation, after each one.
    const int offset = conjugate ? shift : -shift;
    for (TrackedMode& mode : line) {
      mode.shift = offset + (conjugate ? -mode.shift : mode.shift);
      mode.is_conjugate = mode.is_conjugate != conjugate;
    }
  }
  return result;
}

}  // namespace samara::analysis
