#include "hill_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>
#include <slepceps.h>

#include "samara/base/error.hpp"
#include "samara/petsc/options.hpp"

#include "arnoldi.hpp"
#include "complex_solver.hpp"
#include "hill_without_medium.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;
using Index = Eigen::Index;
using Vector = Eigen::VectorXcd;

/// Relative tolerances of the eigensolver and of its linear solves. Without harmonics, a solve
/// takes an iteration or two, and the eigenvalues of the pairs that are found differ by many
/// orders.
struct Tolerances {
  double eigenvalues;
  double linear;
};
constexpr Tolerances of_search{1e-6, 1e-7};
constexpr Tolerances of_search_without_harmonics{1e-11, 1e-13};

/// Real part of the shifts, relative to the rotor speed. Undamped motions, whose exponents are
/// imaginary, have real eigenvalues for an imaginary shift, equal to those of their conjugates.
constexpr double real_part_of_shift = 0.3;

/// Least distance of an exponent from the real part of the shift, relative to the imaginary part,
/// at which the eigenvalue gives it; and relative difference from the approximation above which the
/// eigenvalue is that of something else.
constexpr double least_distance = 0.1;
constexpr double largest_correction = 0.5;
/// Imaginary part of a real exponent, relative to the exponent or to the rotor speed.
constexpr double round_off = 1e-9;
constexpr double no_exponent = std::numeric_limits<double>::infinity();

/// Restarts of the eigensolver in which no further pair converges, after which it ends with those
/// that it has: the others are smaller than the round-off of the largest ones.
constexpr PetscInt restarts_without_progress = 8;

/// Solves (A + sigma B) y = B x for real x.
struct ShiftInvert {
  HillPencil& pencil;
  ComplexSolver& solver;
  Vector in = {};
  Vector right = {};
  Vector out = {};
  std::exception_ptr error = {};
};

/// The lower end of an edge, relative to the rotor speed. Parts of a side are first as long as this
/// factor of half the width beside it, not less than the rotor speed, and not more than the second
/// factor of it or this part of the side: one exponent changes the phase by less than pi along a
/// straight line. Change of a phase [rad] in a part, and difference of its halves, at most.
constexpr double beside_real_axis = 1e-6;
constexpr double of_half_width = 3.0;
constexpr double widest = 12.0;
constexpr double part_of_side = 0.02;
constexpr double most_change = 1.5;
constexpr double most_difference = 0.3;
/// Difference of numbers of eigenvalues that are the same.
constexpr double same_number = 0.1;
constexpr int most_points = 1000;
constexpr double most_parts_of_side = 150.0;  ///< at first
/// Vectors by which the contraction is estimated, at most and at least; the estimate, with its
/// residual, below which the least number is enough; and a norm of round-off.
constexpr int contraction_steps = 8;
constexpr int least_contraction_steps = 3;
constexpr double small_contraction = 0.5;
constexpr double least_change = 1e-14;

/// Real vectors of the eigensolver: mean, then sqrt(2) times real and negative imaginary part of
/// z_k, k > 0, for each unknown, which keeps the norm of the series.
void from_real(const PetscScalar* values, Index width, Vector& x) {
  const Index H = (width - 1) / 2;
  for (Index first = 0; first < x.size(); first += width) {
    x(first + H) = values[first];
    for (Index k = 1; k <= H; ++k) {
      const Complex z =
          std::numbers::sqrt2 / 2.0 * Complex(values[first + 2 * k - 1], -values[first + 2 * k]);
      x(first + H + k) = z;
      x(first + H - k) = std::conj(z);
    }
  }
}

/// The imaginary part of the function of time that has the series y.
void imaginary_to_real(const Vector& y, Index width, PetscScalar* values) {
  const Index H = (width - 1) / 2;
  for (Index first = 0; first < y.size(); first += width) {
    values[first] = y(first + H).imag();
    for (Index k = 1; k <= H; ++k) {
      const Complex z = Complex(0.0, -0.5) * (y(first + H + k) - std::conj(y(first + H - k)));
      values[first + 2 * k - 1] = std::numbers::sqrt2 * z.real();
      values[first + 2 * k] = -std::numbers::sqrt2 * z.imag();
    }
  }
}

PetscErrorCode apply_inverse(Mat matrix, Vec x, Vec y) {
  ShiftInvert* context = nullptr;
  PetscCall(MatShellGetContext(matrix, &context));
  try {
    const Index width = context->pencil.width();
    {
      const petsc::ReadView view(x);
      context->in.resize(context->pencil.size());
      from_real(view.data(), width, context->in);
    }
    context->pencil.drop_absent(context->in);
    context->right.resize(context->in.size());
    context->pencil.multiply_mass(context->in, context->right);
    context->solver.solve(context->right, context->out);
    const petsc::WriteView view(y);
    imaginary_to_real(context->out, width, view.data());
  } catch (...) {
    context->error = std::current_exception();
    return PETSC_ERR_USER;
  }
  return 0;
}

struct Progress {
  PetscInt pairs = 0;     ///< converged
  PetscInt restarts = 0;  ///< since then
};

PetscErrorCode stop_without_progress(EPS solver, PetscInt restart, PetscInt most, PetscInt pairs,
                                     PetscInt wanted, EPSConvergedReason* reason, void* context) {
  PetscCall(EPSStoppingBasic(solver, restart, most, pairs, wanted, reason, nullptr));
  Progress& progress = *static_cast<Progress*>(context);
  if (pairs > progress.pairs) progress = {pairs, 0};
  const bool is_last = pairs > 0 && progress.restarts++ >= restarts_without_progress;
  if (*reason == EPS_CONVERGED_ITERATING && is_last) *reason = EPS_CONVERGED_USER;
  return 0;
}

/// The exponent lambda of an eigenvalue -Im(sigma) / ((sigma - lambda) (conj(sigma) - lambda)) next
/// to an approximation by the eigenvector, which has larger errors far from the shift. Near its
/// real part the eigenvalue hardly depends on the exponent, and the approximation stays. Empty
/// where the two do not fit.
std::optional<Complex> exponent_at(Complex shift, Complex eigenvalue, Complex approximation) {
  const double height = shift.imag();
  const Complex square = -height * height - height / eigenvalue;  // (lambda - Re(sigma))^2
  Complex distance = std::sqrt(square);
  if (std::abs(distance) < least_distance * height) return approximation;
  if (std::real(std::conj(distance) * (approximation - shift.real())) < 0.0) distance = -distance;
  const Complex exponent = shift.real() + distance;
  if (!(std::abs(exponent - approximation) < largest_correction * std::abs(approximation)))
    return std::nullopt;
  return exponent;
}

/// Half the width at height y of the region |s^2 + omega^2| <= rho; 0 outside.
double half_width(double omega, double rho, double y) {
  // |x^2 + omega^2 - y^2 + 2 i x y|^2 = rho^2, a quadratic equation for x^2.
  const double a = omega * omega - y * y;
  const double b = a + 2.0 * y * y;
  const double c = a * a - rho * rho;
  return c > 0.0 ? 0.0 : std::sqrt(std::max(0.0, -b + std::sqrt(b * b - c)));
}

/// The largest modulus of an eigenvalue of a map on a Krylov space, and the residual.
double largest_with_residual(const Arnoldi& space) {
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(space.projected());
  Index at = 0;
  const double modulus = solver.eigenvalues().cwiseAbs().maxCoeff(&at);
  return modulus + space.residual(solver.eigenvectors().col(at).normalized());
}

/// A point on the edge of a region, and the logarithm there of a determinant without known zeros.
struct EdgePoint {
  Complex s;
  Complex log;
};

/// What exponents far away add to the logarithm of a determinant: a polynomial with real
/// coefficients. Its imaginary part does not change along a closed curve, or between two points of
/// the real axis.
class Background {
 public:
  /// The real parts at some points are known, the imaginary parts up to multiples of 2 pi.
  explicit Background(const std::vector<EdgePoint>& points) {
    std::vector<const EdgePoint*> known;
    for (const EdgePoint& point : points) {
      unit_ = std::max(unit_, std::abs(point.s));
      if (std::isfinite(point.log.real())) known.push_back(&point);
    }
    const auto rows = static_cast<Index>(known.size());
    const Index terms = std::min(most_terms, rows / points_of_term);
    if (terms == 0) return;
    Eigen::MatrixXd powers(rows, terms);
    Eigen::VectorXd values(rows);
    for (Index i = 0; i < rows; ++i) {
      const EdgePoint& point = *known[static_cast<std::size_t>(i)];
      Complex power = 1.0;
      for (Index k = 0; k < terms; ++k, power *= point.s / unit_) powers(i, k) = power.real();
      values(i) = point.log.real();
    }
    coefficients_ = powers.colPivHouseholderQr().solve(values);
  }

  double phase(Complex s) const {
    Complex sum = 0.0;
    for (Index k = coefficients_.size() - 1; k >= 0; --k) sum = sum * s / unit_ + coefficients_(k);
    return sum.imag();
  }

 private:
  static constexpr Index most_terms = 7;
  static constexpr Index points_of_term = 3;
  double unit_ = 0.0;
  Eigen::VectorXd coefficients_;
};

}  // namespace

ComplexSolver solver_at(HillPencil& pencil, Complex shift, double tolerance) {
  if (!pencil.set_shift(shift))
    throw ConvergenceError("floquet: Hill's method has no factors at " +
                           std::to_string(shift.imag()) + " rad/s");
  return {pencil.size(),
          [&pencil, shift](const Vector& x, Vector& y) { pencil.multiply(x, shift * x, y); },
          [&pencil](const Vector& x, Vector& y) { pencil.precondition(x, y); },
          tolerance,
          "hill_",
          pencil.ranks().comm};
}

HillRegion HillSearch::find(double frequency, int count, double known) {
  pencil_.fit_scales(frequency);
  return pencil_.has_medium() ? HillWithoutMedium(pencil_).find(frequency, count, known)
                              : find_all(frequency, count);
}

HillRegion HillSearch::find_all(double frequency, int count) {
  const Index size = pencil_.size();
  const auto n = static_cast<PetscInt>(size);
  const double beside = real_part_of_shift * pencil_.speed();
  const Complex shift(beside, frequency);
  const Tolerances& tolerances = pencil_.harmonics() > 0 ? of_search : of_search_without_harmonics;
  ComplexSolver linear = solver_at(pencil_, shift, tolerances.linear);
  ShiftInvert context{pencil_, linear};
  petsc::Handle<Mat> inverse;
  MPI_Comm comm = pencil_.ranks().comm;
  petsc::check(
      MatCreateShell(comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, &context, inverse.fill()));
  petsc::check(
      MatShellSetOperation(inverse.get(), MATOP_MULT, reinterpret_cast<void (*)()>(apply_inverse)));
  petsc::Handle<EPS> solver;
  petsc::check(EPSCreate(comm, solver.fill()));
  petsc::check(EPSSetOptionsPrefix(solver.get(), "hill_"));
  petsc::check(EPSSetOperators(solver.get(), inverse.get(), nullptr));
  petsc::check(EPSSetProblemType(solver.get(), EPS_NHEP));
  petsc::check(EPSSetWhichEigenpairs(solver.get(), EPS_LARGEST_MAGNITUDE));
  petsc::check(EPSSetDimensions(solver.get(), 2 * count, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc::check(EPSSetTolerances(solver.get(), tolerances.eigenvalues, PETSC_DEFAULT));
  Progress progress;
  petsc::check(EPSSetStoppingTestFunction(solver.get(), stop_without_progress, &progress, nullptr));
  petsc::take_options(EPSSetFromOptions, solver.get());
  EPSWhich which = EPS_LARGEST_MAGNITUDE;
  petsc::check(EPSGetWhichEigenpairs(solver.get(), &which));
  if (which != EPS_LARGEST_MAGNITUDE)
    throw InputError(
        "floquet: Hill's method needs the largest eigenvalues of the inverse; hint: no -hill_eps_ "
        "option for other ones; floquet.near_hz chooses the modes");
  const PetscErrorCode code = EPSSolve(solver.get());
  if (context.error) std::rethrow_exception(context.error);
  petsc::check(code);
  PetscInt converged = 0;
  petsc::check(EPSGetConverged(solver.get(), &converged));
  if (converged < 2) throw ConvergenceError("floquet: Hill's method finds no modes");

  HillRegion region;
  double least = 0.0;
  const petsc::Handle<Vec> re = petsc::make_vector(comm, n, PETSC_DETERMINE);
  const petsc::Handle<Vec> im = petsc::make_vector(comm, n, PETSC_DETERMINE);
  Vector x(size);
  Vector y(size);
  double last_im = 0.0;
  for (PetscInt i = 0; i < converged; ++i) {
    PetscScalar value_re = 0.0;
    PetscScalar value_im = 0.0;
    // How many others have converged depends on the start of the iteration.
    if (i >= 2 * count && last_im <= 0.0) break;  // not between the two of a pair
    petsc::check(EPSGetEigenpair(solver.get(), i, &value_re, &value_im, re.get(), im.get()));
    last_im = value_im;
    const double modulus = std::hypot(value_re, value_im);
    if (least == 0.0) least = modulus;
    {
      const petsc::ReadView view(re.get());
      from_real(view.data(), pencil_.width(), x);
    }
    {
      const petsc::ReadView view(im.get());
      from_real(view.data(), pencil_.width(), y);
    }
    x += Complex(0.0, 1.0) * y;
    const Complex approximation = pencil_.exponent_of(x);
    Complex exponent =
        pencil_.harmonics() > 0
            ? approximation
            : exponent_at(shift, {value_re, value_im}, approximation).value_or(no_exponent);
    // A real motion has a real exponent; as one with a conjugate it would count twice.
    if (value_im == 0.0 &&
        std::abs(exponent.imag()) < round_off * std::max(std::abs(exponent), pencil_.speed()))
      exponent.imag(0.0);
    const double expected =
        frequency / std::abs((shift - exponent) * (std::conj(shift) - exponent));
    if (!(std::abs(expected - modulus) <= 0.5 * modulus)) {  // of an infinite exponent
      // Without harmonics, exponents in the range differ so much that some eigenvectors next to the
      // last ones are not accurate; others follow from a shift next to them.
      region.is_whole = pencil_.harmonics() > 0 || i == 0;
      break;
    }
    least = std::min(least, modulus);
    if (value_im != 0.0 && exponent.imag() < 0.0) continue;  // its conjugate is kept
    region.pairs.push_back({exponent, pencil_.series_of(pencil_.normalized(x))});
  }
  // All eigenvalues with larger moduli have converged.
  double rho = frequency / least * (1.0 - 1e-6);
  if (region.is_whole) rho = HillRegion::beyond_all * (rho + std::norm(10.0 * pencil_.speed()));
  const double omega2 = frequency * frequency;
  // A part of the range on the axis, so that the rectangle has a width.
  for (double part = 0.85; part > 0.1; part -= 0.15) {
    region.high = std::sqrt(omega2 + part * rho);
    region.low = part * rho >= omega2 ? 0.0 : std::sqrt(omega2 - part * rho);
    region.decay =
        std::min(half_width(frequency, rho, region.low), half_width(frequency, rho, region.high)) -
        beside;
    if (region.decay > beside) break;
  }
  region.growth = region.decay;
  for (double* value : {&region.low, &region.high, &region.decay, &region.growth})
    pencil_.ranks().share(0, *value);
  std::size_t pairs = region.pairs.size();
  pencil_.ranks().share(0, pairs);
  if (!pencil_.ranks().all(pairs == region.pairs.size()))
    throw ConvergenceError("floquet: the ranks differ in the number of modes next to " +
                           std::to_string(frequency) + " rad/s; hint: processors of one kind");
  for (HillPair& pair : region.pairs) pencil_.ranks().share(0, pair.exponent);
  return region;
}

/// Logarithms of the determinant of the preconditioner; not a number where it is singular. The
/// ranks share the points that are new.
std::vector<Complex> HillSearch::logs_at(const std::vector<Complex>& points, const Ranks& ranks) {
  const auto key = [](Complex s) { return std::pair(s.real(), s.imag()); };
  std::vector<Complex> missing;
  for (const Complex s : points)
    if (!logs_.contains(key(s))) missing.push_back(s);
  Eigen::MatrixXcd values = Eigen::MatrixXcd::Zero(static_cast<Index>(missing.size()), 1);
  ranks.attempt([&] {
    for (std::size_t i = 0; i < missing.size(); ++i)
      if (static_cast<int>(i) % ranks.size == ranks.rank)
        values(static_cast<Index>(i)) = pencil_.set_shift(missing[i])
                                            ? pencil_.log_determinant()
                                            : Complex(std::numeric_limits<double>::quiet_NaN(),
                                                      std::numeric_limits<double>::quiet_NaN());
  });
  ranks.sum(values);
  pencil_.ranks().share(0, values);
  for (std::size_t i = 0; i < missing.size(); ++i)
    logs_.emplace(key(missing[i]), values(static_cast<Index>(i)));
  std::vector<Complex> logs;
  for (const Complex s : points) logs.push_back(logs_.at(key(s)));
  return logs;
}

double HillSearch::contraction_at(Complex s) {
  const std::pair key(s.real(), s.imag());
  if (const auto known = contractions_.find(key); known != contractions_.end())
    return known->second;
  return contractions_.emplace(key, find_contraction(s)).first->second;
}

/// By Arnoldi's method from a vector of all harmonics, with the factors at s.
double HillSearch::find_contraction(Complex s) {
  const bool eliminates = pencil_.has_medium();
  if (!pencil_.set_shift(s) || (eliminates && !pencil_.prepare_elimination()))
    return std::numeric_limits<double>::infinity();
  Vector x = Vector::Constant(pencil_.size(), Complex(1.0, 0.5));
  for (Index i = 0; i < x.size(); ++i) x(i) *= 1.0 + 0.5 * std::sin(static_cast<double>(i));
  pencil_.drop_absent(x);
  if (eliminates) pencil_.drop_medium(x);
  Vector product(x.size());
  Vector y(x.size());
  const auto change_of = [&](const Vector& of) {  // by 1 less the preconditioned pencil
    if (eliminates) {
      pencil_.multiply_eliminated(of, y);
    } else {
      pencil_.multiply(of, s * of, product);
      pencil_.precondition(product, y);
    }
    return Vector(of - y);
  };
  // The first vector has the components that the preconditioner changes.
  const Vector start = change_of(x);
  const Ranks& parts = pencil_.ranks();
  const double size = parts.norm(start);
  if (!std::isfinite(size)) return std::numeric_limits<double>::infinity();
  if (size == 0.0) return 0.0;
  Arnoldi space(start, contraction_steps, parts);
  double largest = 0.0;
  bool is_last = false;
  while (!is_last) {
    const Vector image = change_of(space.last());
    if (!std::isfinite(parts.norm(image))) return std::numeric_limits<double>::infinity();
    is_last = !space.extend(image, least_change) || space.size() == contraction_steps;
    largest = largest_with_residual(space);
    parts.share(0, largest);
    is_last = is_last || (space.size() >= least_contraction_steps && largest < small_contraction);
  }
  return largest;
}

HillSearch::Missing HillSearch::count_missing(const HillRegion& region,
                                              const std::vector<Complex>& found,
                                              const Ranks& ranks) {
  Missing result;
  // Factors for a real shift are those of half of the harmonics.
  const double low = std::max(region.low, beside_real_axis * pencil_.speed());
  std::vector<Complex> corners{{region.growth, low},
                               {region.growth, region.high},
                               {-region.decay, region.high},
                               {-region.decay, low}};
  const bool is_closed = region.low > 0.0;
  if (is_closed) corners.push_back(corners.front());
  const auto evaluate = [&](std::vector<EdgePoint>& points) {
    std::vector<Complex> places;
    for (const EdgePoint& point : points) places.push_back(point.s);
    const std::vector<Complex> logs = logs_at(places, ranks);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].log = logs[i];
      for (const Complex exponent : found) {
        points[i].log -= std::log(points[i].s - exponent);
        if (exponent.imag() > 0.0) points[i].log -= std::log(points[i].s - std::conj(exponent));
      }
    }
    result.points += static_cast<int>(points.size());
  };
  std::vector<EdgePoint> edge;  // ends and middles of parts
  for (std::size_t side = 0; side + 1 < corners.size(); ++side) {
    const Complex length = corners[side + 1] - corners[side];
    const std::array<double, 4> widths{region.growth, std::min(region.growth, region.decay),
                                       region.decay, std::min(region.growth, region.decay)};
    const double most = std::max(widest * pencil_.speed(), part_of_side * std::abs(length));
    const double longest = std::max({pencil_.speed(), std::min(of_half_width * widths[side], most),
                                     std::abs(length) / most_parts_of_side});
    const auto halves = 2 * static_cast<int>(std::ceil(std::abs(length) / longest));
    for (int half = 0; half < halves; ++half)
      edge.push_back({corners[side] + length * (static_cast<double>(half) / halves), 0.0});
  }
  edge.push_back({corners.back(), 0.0});
  evaluate(edge);
  const Background background(edge);
  const auto change = [&background](const EdgePoint& from, const EdgePoint& to) {
    return std::remainder(
        to.log.imag() - background.phase(to.s) - from.log.imag() + background.phase(from.s),
        2.0 * std::numbers::pi);
  };
  struct Part {
    EdgePoint begin, middle, end;
  };
  std::vector<Part> parts;
  for (std::size_t i = 2; i < edge.size(); i += 2)
    parts.push_back({edge[i - 2], edge[i - 1], edge[i]});
  // Parts are halved until the phase changes little, and as much in one half as in the other.
  double sum = 0.0;
  while (!parts.empty()) {
    std::vector<Part> left;
    for (const Part& part : parts) {
      const double first = change(part.begin, part.middle);
      const double second = change(part.middle, part.end);
      if (std::abs(first) + std::abs(second) < most_change &&
          std::abs(first - second) < most_difference) {
        sum += first + second;
        continue;
      }
      left.push_back({part.begin, {}, part.middle});
      left.push_back({part.middle, {}, part.end});
    }
    parts = std::move(left);
    if (result.points > most_points) break;
    std::vector<EdgePoint> middles;
    for (const Part& part : parts) middles.push_back({0.5 * (part.begin.s + part.end.s), 0.0});
    evaluate(middles);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].middle = middles[i];
  }
  // The part below the real axis has the same change of the phase.
  const double number = sum / (is_closed ? 2.0 * std::numbers::pi : std::numbers::pi);
  if (parts.empty() && std::abs(number - std::round(number)) < same_number)
    result.eigenvalues = static_cast<int>(std::lround(number));
  // Without harmonics, the preconditioner is the inverse of the pencil.
  if (result.eigenvalues != 0 || pencil_.harmonics() == 0) return result;
  ranks.attempt([&] {
    int point = 0;
    for (std::size_t side = 0; side + 1 < corners.size(); ++side)
      for (const double part : {0.02, 0.25, 0.5, 0.75, 0.98})
        if (point++ % ranks.size == ranks.rank)
          result.contraction =
              std::max(result.contraction,
                       contraction_at(corners[side] + part * (corners[side + 1] - corners[side])));
  });
  result.contraction = ranks.largest(result.contraction);
  return result;
}

}  // namespace samara::analysis
