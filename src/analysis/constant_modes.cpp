#include "samara/analysis/constant_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "samara/analysis/consistent_subspace.hpp"
#include "samara/analysis/harmonic_energy.hpp"
#include "samara/analysis/hill.hpp"
#include "samara/analysis/identification.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/mode_error.hpp"
#include "samara/base/error.hpp"

#include "energy_coordinates.hpp"
#include "massless_states.hpp"
#include "mode_selection.hpp"
#include "state_parts.hpp"

namespace samara::analysis {
namespace {

using Complex = std::complex<double>;

/// Largest relative change over a period of a row of tangents that count as constant.
constexpr double constant_tolerance = 1e-9;

/// The second shift relative to the first, and the largest relative difference of a resolved
/// exponent between two shifts. Double precision does not resolve the frequencies of the stiffest
/// strains of a fine mesh.
constexpr double check_shift = 3.0;
constexpr double largest_difference = 1e-6;

/// Number of the slowest modes, which have a shift of their own.
constexpr std::size_t slow_modes = 12;
/// Modes that are slower than that shift by this factor have another one.
constexpr double much_slower = 1e-3;

/// Relative to the shift: a smaller exponent is zero (a double zero in double precision).
constexpr double zero_to_shift = 1e-7;
/// Relative to the shift: a smaller exponent that differs for another shift belongs to a double
/// zero, which round-off splits by its square root.
constexpr double split_to_shift = 1e-5;

/// Of moduli that choose a number of steps: about three digits.
constexpr double tolerance_of_moduli = 1e-5;

struct Spectrum {
  std::vector<Complex> exponents;
  std::vector<int> states;  ///< see leading_states()
  Eigen::MatrixXcd shapes;  ///< size x modes
};

void require_constant(const system::PeriodicSystem& system, const PeriodicSolution& solution) {
  if (system.period() == 0.0) return;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Mat> jacobian = system.make_jacobian();
  const auto tangents = [&](double t) {
    solution.evaluate(t, z.get(), z_dot.get());
    system.tangents(t, z.get(), z_dot.get(), 1.0, jacobian.get(), nullptr);
    return to_sparse(jacobian.get());
  };
  const Eigen::SparseMatrix<double> first = tangents(0.0);
  const Eigen::VectorXd sizes = first.cwiseAbs() * Eigen::VectorXd::Ones(first.cols());
  for (const double part : {0.12, 0.31, 0.47, 0.78}) {
    const Eigen::SparseMatrix<double> change = tangents(part * system.period()) - first;
    const Eigen::VectorXd changes = change.cwiseAbs() * Eigen::VectorXd::Ones(first.cols());
    for (Eigen::Index i = 0; i < sizes.size(); ++i)
      if (changes(i) > constant_tolerance * std::max(sizes(i), 1.0))
        throw InputError(
            "modes: the coefficients are periodic in the azimuth; hint: samara floquet, or samara "
            "modes --parked for the rotor at rest");
  }
}

/// K + sigma M and M on the solution at t = 0.
struct ShiftedTangents {
  ShiftedTangents(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                  double sigma)
      : shifted(system.make_jacobian()) {
    const petsc::Handle<Vec> z = system.make_state();
    const petsc::Handle<Vec> z_dot = system.make_state();
    const petsc::Handle<Mat> mass = system.make_mass();
    solution.evaluate(0.0, z.get(), z_dot.get());
    system.tangents(0.0, z.get(), z_dot.get(), sigma, shifted.get(), mass.get());
    M = to_sparse(mass.get());
  }

  petsc::Handle<Mat> shifted;
  Eigen::SparseMatrix<double> M;
};

DirectSolver solver_of(const system::PeriodicSystem& system, double sigma) {
  return {"modes_", [&system, sigma](Mat matrix) { return scale_by_role(system, matrix, sigma); }};
}

/// (sigma - A)^-1 of the states, in energy coordinates, and the shapes that it leads to.
struct ShiftedInverse {
  Eigen::MatrixXd map;     ///< states x states
  Eigen::MatrixXd shapes;  ///< size x states
};

/// The consistent states on the solution at t = 0, and (sigma - A)^-1 of them for any shift.
class StateInverses {
 public:
  /// `rate`: of the energy coordinates, and a shift for which tangents are evaluated.
  StateInverses(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                const ConsistentSubspace& subspace, double rate)
      : system_(system),
        solution_(solution),
        subspace_(subspace),
        states_(subspace_.basis(0.0)),
        coordinates_(system, states_, subspace_.degrees_of_freedom(), rate) {
    if (coordinates_.without_inertia().cols() > 0) {
      const ShiftedTangents tangents(system, solution, rate);
      massless_ = MasslessStates(to_sparse(tangents.shifted.get()) - rate * tangents.M, tangents.M,
                                 states_, coordinates_);
    }
    coordinates_.divide(states_);
  }

  [[nodiscard]] int size() const { return subspace_.size(); }
  [[nodiscard]] int degrees_of_freedom() const { return subspace_.degrees_of_freedom(); }
  /// States that the maps map among each other.
  [[nodiscard]] const MasslessStates& massless() const { return massless_; }

  /// If x is a consistent state, y of (K + sigma M) y = M x is one, too, with the rate
  /// sigma y - x. In (eta, eta_dot, xi) the map from x to y is (sigma - A)^-1; it multiplies a
  /// state with exponent lambda by 1 / (sigma - lambda).
  [[nodiscard]] ShiftedInverse at(double sigma) const {
    const ShiftedTangents tangents(system_, solution_, sigma);
    DirectSolver solver = solver_of(system_, sigma);
    const Eigen::Index d = degrees_of_freedom();
    ShiftedInverse inverse;
    inverse.shapes = tangents.M * states_;
    solver.factor(tangents.shifted.get());  // scales it
    solver.solve(inverse.shapes);
    Eigen::MatrixXd images(size(), size());
    images.topRows(d) = subspace_.coordinates_of(inverse.shapes);
    images.middleRows(d, d) = sigma * images.topRows(d) - subspace_.coordinates_of(states_);
    images.bottomRows(subspace_.first_order()) = subspace_.states_of(inverse.shapes);
    inverse.map = coordinates_.of(images);
    return inverse;
  }

 private:
  const system::PeriodicSystem& system_;
  const PeriodicSolution& solution_;
  const ConsistentSubspace& subspace_;
  Eigen::MatrixXd states_;  ///< size x states, per unit of each energy coordinate
  EnergyCoordinates coordinates_;
  MasslessStates massless_;
};

/// The exponents of eigenvalues 1 / (sigma - lambda).
std::vector<Complex> exponents_of(double sigma, std::vector<Complex> of_inverse) {
  for (Complex& value : of_inverse) value = sigma - 1.0 / value;
  return of_inverse;
}

Spectrum find_spectrum(const system::PeriodicSystem& system, const StateInverses& inverses,
                       double sigma) {
  const ShiftedInverse inverse = inverses.at(sigma);
  const Eigenpairs pairs = inverses.massless().eigenpairs_of(inverse.map, "modes_");
  const std::vector<int> states_of_pairs =
      leading_states(pairs, 2 * inverses.degrees_of_freedom(), find_state_parts(system));
  Spectrum spectrum;
  std::vector<Eigen::VectorXcd> combinations;
  for (std::size_t i = 0; i < pairs.values.size(); ++i) {
    const Complex exponent = Complex(sigma) - 1.0 / pairs.values[i];
    if (exponent.imag() < 0.0) continue;
    const Eigen::VectorXcd vector = pairs.vectors.col(static_cast<Eigen::Index>(i));
    const auto keep = [&](Complex value, const Eigen::VectorXcd& combination) {
      spectrum.exponents.push_back(value);
      spectrum.states.push_back(states_of_pairs[i]);
      combinations.push_back(combination);
    };
    if (exponent.imag() > 0.0 && std::abs(exponent) < zero_to_shift * sigma) {
      // Round-off has split a double zero into a complex pair. It is kept as two real modes, like a
      // double zero that round-off splits into two real exponents.
      keep(exponent.real(), real_part(vector));
      keep(exponent.real(), real_part(vector));
    } else {
      keep(exponent, vector);
    }
  }
  const auto modes = static_cast<Eigen::Index>(combinations.size());
  Eigen::MatrixXd parts(inverse.shapes.cols(), 2 * modes);
  for (Eigen::Index k = 0; k < modes; ++k) {
    parts.col(k) = combinations[static_cast<std::size_t>(k)].real();
    parts.col(modes + k) = combinations[static_cast<std::size_t>(k)].imag();
  }
  const Eigen::MatrixXd shapes = multiply(inverse.shapes, parts);
  spectrum.shapes.resize(system.size(), modes);
  spectrum.shapes.real() = shapes.leftCols(modes);
  spectrum.shapes.imag() = shapes.rightCols(modes);
  return spectrum;
}

/// The exponents alone, both of a conjugate pair.
std::vector<Complex> find_exponents(const StateInverses& inverses, double sigma) {
  return exponents_of(sigma,
                      dense_eigenvalues(inverses.massless().without(inverses.at(sigma).map)));
}

/// Moduli of the exponents that are not zero, one of a conjugate pair, ascending.
std::vector<double> moduli_of(const std::vector<Complex>& exponents, double zero) {
  std::vector<double> moduli;
  for (const Complex& exponent : exponents)
    if (exponent.imag() >= 0.0 && std::abs(exponent) > zero) moduli.push_back(std::abs(exponent));
  std::sort(moduli.begin(), moduli.end());
  return moduli;
}

/// Geometric mean of `count` moduli from number `first`.
double middle_of(const std::vector<double>& moduli, std::size_t first, std::size_t count,
                 double fallback) {
  const std::size_t end = std::min(first + count, moduli.size());
  double sum = 0.0;
  for (std::size_t i = first; i < end; ++i) sum += std::log(moduli[i]);
  return end > first ? std::exp(sum / static_cast<double>(end - first)) : fallback;
}

/// The geometric middle of the gap between two moduli that has the largest ratio, of the gaps that
/// have a part in [low, high].
double widest_gap(const std::vector<double>& moduli, double low, double high) {
  double gap = 1.0;
  double middle = low;
  for (std::size_t i = 1; i < moduli.size(); ++i) {
    const double ratio = moduli[i] / moduli[i - 1];
    if (moduli[i] < low || moduli[i - 1] > high || ratio <= gap) continue;
    gap = ratio;
    middle = std::sqrt(moduli[i] * moduli[i - 1]);
  }
  return middle;
}

/// A shift, its spectrum, and the exponents of the second shift.
struct CheckedSpectrum {
  double sigma = 0.0;
  Spectrum found;
  std::vector<Complex> check;
};

/// Distance to the nearest of other exponents, relative to the larger of itself and `zero`.
double distance(Complex exponent, const std::vector<Complex>& others, double zero) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Complex& candidate : others)
    nearest = std::min(nearest, std::abs(candidate - exponent));
  return nearest / std::max(std::abs(exponent), zero);
}

/// At least `count` eigenvalues 1 / (sigma - lambda) of largest modulus of the tangents at t = 0,
/// fewer where they do not converge: of y for x with (K + sigma M) y = M x, for the unknowns that M
/// contains, in the units by which the solver scales.
std::vector<Complex> largest_inverses(const system::PeriodicSystem& system,
                                      const PeriodicSolution& solution, double sigma, int count) {
  const ShiftedTangents tangents(system, solution, sigma);
  DirectSolver solver = solver_of(system, sigma);
  solver.factor(tangents.shifted.get());
  std::vector<Eigen::Index> places;
  for (Eigen::Index i = 0; i < system.size(); ++i)
    if (system.differential()[static_cast<std::size_t>(i)]) places.push_back(i);
  const petsc::ReadView units(solver.scaling().columns.get());
  const Eigen::VectorXd scale =
      Eigen::Map<const Eigen::VectorXd>(units.data(), system.size())(places);
  Eigen::MatrixXd values;
  return largest_eigenvalues(
      scale.size(),
      [&](const Eigen::VectorXd& x) {
        Eigen::VectorXd all = Eigen::VectorXd::Zero(system.size());
        all(places) = x.cwiseProduct(scale);
        values = tangents.M * all;
        solver.solve(values);
        return Eigen::VectorXd(values(places, 0).cwiseQuotient(scale));
      },
      count, tolerance_of_moduli);
}

}  // namespace

std::vector<double> find_moduli_at_start(const system::PeriodicSystem& system,
                                         const PeriodicSolution& solution, int count) {
  const ConsistentSubspace subspace(system, solution);
  if (subspace.size() == 0) return {};
  const double rate = system::base_rate(system);
  const double zero = zero_exponent * rate;
  // Both of a pair, and some that count as zero.
  const int values = 3 * count;
  constexpr int whole_below = 12;  // times the number that is wanted
  if (subspace.size() >= whole_below * values) {
    std::vector<Complex> found = largest_inverses(system, solution, rate, values);
    if (found.size() >= static_cast<std::size_t>(values))
      return moduli_of(exponents_of(rate, std::move(found)), zero);
  }
  return moduli_of(find_exponents(StateInverses(system, solution, subspace, rate), rate), zero);
}

ModeSet find_constant_modes(const system::PeriodicSystem& system,
                            const PeriodicSolution& solution) {
  require_constant(system, solution);
  const ConsistentSubspace subspace(system, solution);
  if (subspace.size() == 0)
    throw InputError("modes: nothing can move, all strains and joints are rigid");
  const double rate = system::base_rate(system);
  const StateInverses inverses(system, solution, subspace, rate);
  const double speed = system.period() > 0.0 ? 2.0 * std::numbers::pi / system.period() : 0.0;
  const auto checked = [&](double sigma) {
    return CheckedSpectrum{sigma, find_spectrum(system, inverses, sigma),
                           find_exponents(inverses, check_shift * sigma)};
  };
  // The error of an exponent is about the round-off of max(sigma, |lambda|^2 / sigma). The slow
  // modes, which are of interest, and the fast modes, which a fine mesh adds, therefore have a
  // shift each, and so have modes that are much slower than the other slow ones.
  const double zero = zero_exponent * rate;
  const MasslessStates& massless = inverses.massless();
  const std::vector<double> moduli = moduli_of(find_exponents(inverses, rate), zero);
  const auto first_above = [&moduli](double limit) {
    return static_cast<std::size_t>(std::lower_bound(moduli.begin(), moduli.end(), limit) -
                                    moduli.begin());
  };
  // Moduli below the first of these may belong to a double zero.
  const std::size_t first = first_above(split_to_shift * rate);
  const std::size_t slowest = first_above(much_slower * middle_of(moduli, 0, slow_modes, rate));
  std::vector<double> shifts;
  if (slowest > first) shifts.push_back(middle_of(moduli, first, slowest - first, rate));
  shifts.push_back(middle_of(moduli, slowest > first ? slowest : 0, slow_modes, rate));
  shifts.push_back(middle_of(moduli, 0, moduli.size(), rate));
  std::vector<CheckedSpectrum> spectra;
  for (const double shift : shifts) spectra.push_back(checked(shift));
  std::vector<double> borders;  // above each spectrum but the last
  for (std::size_t i = 0; i + 1 < spectra.size(); ++i)
    borders.push_back(widest_gap(moduli_of(spectra[i].found.exponents, zero), spectra[i].sigma,
                                 spectra[i + 1].sigma));

  struct Found {
    Complex exponent;
    const CheckedSpectrum* spectrum;
    Eigen::Index column;
  };
  std::vector<Found> order;
  int exponents = 0;
  const auto collect = [&] {
    order.clear();
    exponents = 0;
    for (std::size_t s = 0; s < spectra.size(); ++s)
      for (std::size_t i = 0; i < spectra[s].found.exponents.size(); ++i) {
        const Complex exponent = spectra[s].found.exponents[i];
        const double size = std::abs(exponent);
        if ((s > 0 && size <= borders[s - 1]) || (s < borders.size() && size > borders[s]))
          continue;
        order.push_back({exponent, &spectra[s], static_cast<Eigen::Index>(i)});
        exponents += exponent.imag() != 0.0 ? 2 : 1;
      }
  };
  collect();
  // A mode that two shifts place on different sides of a border is lost or found twice. Then all
  // modes are those of the fast shift.
  if (exponents != inverses.size() - massless.count()) {
    std::fill(borders.begin(), borders.end(), -1.0);
    collect();
  }
  std::vector<Complex> exponents_found;
  std::vector<Eigen::MatrixXcd> shapes;
  for (const Found& found : order) {
    exponents_found.push_back(found.exponent);
    shapes.emplace_back(found.spectrum->found.shapes.col(found.column));
  }
  choose_shapes(system, exponents_found, shapes);
  const StateParts state_parts = find_state_parts(system);
  HarmonicEnergy energy(system);
  const Eigen::VectorXcd one = Eigen::VectorXcd::Ones(1);
  const std::vector<system::MeshError> elements = system.mesh_errors();
  ModeSet set;
  set.states = inverses.size() - massless.count();
  set.degrees_of_freedom = inverses.degrees_of_freedom() - massless.directions();
  set.rotor_speed = speed;
  set.conservative = system.is_conservative();
  set.shape_times = {0.0};
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Found& found = order[i];
    const Eigen::MatrixXcd& shape = shapes[i];
    Mode mode;
    Eigen::MatrixXd real(energy.signals(), 1);
    Eigen::MatrixXd imaginary(energy.signals(), 1);
    Eigen::VectorXd participation;
    energy.take(shape.real(), real);
    energy.take(shape.imag(), imaginary);
    const int state = found.spectrum->found.states[static_cast<std::size_t>(found.column)];
    if (state >= 0) mode.state = state_parts.owners[static_cast<std::size_t>(state)];
    describe_energy(energy.energies(real.data(), imaginary.data(), one), energy.part_names(), state,
                    mode, participation);
    mode.exponent = exponents_found[i];
    if (std::abs(mode.exponent) < std::max(zero, zero_to_shift * found.spectrum->sigma))
      mode.exponent = 0.0;
    mode.residual =
        mode.exponent == 0.0 ? 0.0 : distance(mode.exponent, found.spectrum->check, zero);
    if (mode.residual > largest_difference &&
        std::abs(mode.exponent) < split_to_shift * found.spectrum->sigma) {
      mode.exponent = 0.0;
      mode.residual = 0.0;
    }
    mode.resolved = mode.residual <= largest_difference;
    mode.step_exponent = mode.exponent;
    mode.round_off_error = mode.residual;
    set_growth_error(mode, {}, mode.exponent);
    if (mode.resolved && mode.exponent != 0.0)
      add_mesh_error(mode, find_mesh_error(system, elements, mode, shape));
    if (!mode.resolved && !is_of_medium(mode))
      set.reach = std::min(set.reach, std::abs(mode.exponent));
    set.found += found.exponent.imag() != 0.0 ? 2 : 1;
    const double size = std::abs(mode.exponent);
    mode.damping_ratio = size > 0.0 ? -mode.exponent.real() / size : 0.0;
    set.modes.push_back(mode);
    set.shapes.push_back(shape);
  }
  name_modes(system, separate_motions(system, solution, set), set);
  arrange_modes(set);
  scale_shapes(system, set);
  return set;
}

ModeSet find_constant_modes(const system::PeriodicSystem& system, const PeriodicSolution& solution,
                            const FloquetOptions& options, MPI_Comm comm, Observer& observer) {
  if (asks_for_some(options) && options.search != ModeSearch::all) {
    require_constant(system, solution);
    if (std::optional<ModeSet> found = find_hill_constant_modes(system, solution, options, comm))
      return std::move(*found);
    observer.note("modes: all modes, because the mesh is too coarse for Hill's method");
  }
  ModeSet set = find_constant_modes(system, solution);
  if (asks_for_some(options)) leave_wanted(set, options);
  return set;
}

}  // namespace samara::analysis
