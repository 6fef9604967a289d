#include "samara/analysis/trim.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <sstream>

#include "samara/analysis/harmonic_balance.hpp"
#include "samara/analysis/linear_algebra.hpp"
#include "samara/analysis/shooting.hpp"
#include "samara/analysis/static_path.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/session.hpp"

#include "settled_start.hpp"

namespace samara::analysis {
namespace {

/// Residual relative to the largest internal load: below it a constant is the solution.
constexpr double round_off = 1e-11;
/// Relative to the largest residual of the undeformed system: a larger change is no round-off.
constexpr double changing = 1e-6;

double allowed_residual(const Trim& trim, double relative) {
  return relative * std::max(trim.load_level, 1.0);
}

/// Numbers of harmonics that may fail before a solution with more of them is given up.
constexpr int most_failures = 5;

/// Residual of evolution and definition rows, relative to their terms, below which a constant state
/// is the solution.
constexpr double state_round_off = 1e-9;

/// With Q identical blades the loads on the tower are at multiples of Q. If H + 1 is such a
/// multiple, harmonic H of the blades causes a load at H + 1 that is not balanced: H + 1 must not
/// be a multiple of Q.
bool is_closed(int harmonics, int sectors) { return sectors < 2 || (harmonics + 1) % sectors != 0; }

/// True where loads on the undeformed system, or a prescribed motion, change with time: no constant
/// balances them.
bool feels_time(const system::PeriodicSystem& system) {
  if (!system.constraints_are_autonomous()) return true;
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> first = system.make_state();
  const petsc::Handle<Vec> other = system.make_state();
  system.reference_state(0.0, z.get());
  system.residual(0.0, z.get(), z_dot.get(), first.get());
  PetscReal size = 0.0;
  petsc::check(VecNorm(first.get(), NORM_INFINITY, &size));
  for (const double turn : {0.13, 0.29, 0.61}) {
    system.residual(turn * system.period(), z.get(), z_dot.get(), other.get());
    petsc::check(VecAXPY(other.get(), -1.0, first.get()));
    PetscReal change = 0.0;
    petsc::check(VecNorm(other.get(), NORM_INFINITY, &change));
    if (change > changing * size) return true;
  }
  return false;
}

/// True where the undeformed system is in equilibrium.
bool is_balanced(const system::PeriodicSystem& system) {
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  const petsc::Handle<Vec> r = system.make_state();
  system.reference_state(0.0, z.get());
  system.residual(0.0, z.get(), z_dot.get(), r.get());
  PetscReal size = 0.0;
  petsc::check(VecNorm(r.get(), NORM_INFINITY, &size));
  return size == 0.0;
}

Eigen::VectorXd undeformed_state(const system::PeriodicSystem& system) {
  const petsc::Handle<Vec> z = system.make_state();
  system.reference_state(0.0, z.get());
  const petsc::ReadView view(z.get());
  return Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
}

/// Solves at rest. A hinge that only loads restore has a singular tangent in the undeformed state:
/// the start is then the end of the static path. Without loads the undeformed state is the
/// solution.
Trim solve_at_rest(const system::PeriodicSystem& system, double tolerance, MPI_Comm comm) {
  const auto solve = [&](const PeriodicSolution* start) {
    try {
      return solve_harmonic_balance(system, 0, tolerance, start, comm);
    } catch (const SingularError& error) {
      throw InputError(error.what());
    }
  };
  // Where Newton's method does not converge, it does so from a state with a settled medium.
  const auto solve_or_settle = [&](const PeriodicSolution* start) {
    try {
      return solve(start);
    } catch (const ConvergenceError&) {
      if (!system::has_medium(system.unknowns())) throw;
      const std::optional<PeriodicSolution> settled = find_settled_start(
          system, start == nullptr ? undeformed_state(system)
                                   : Eigen::VectorXd(start->coefficients().col(0)));
      if (!settled) throw;
      return solve(&*settled);
    }
  };
  if (system.free_coordinates().empty() || is_balanced(system)) return solve_or_settle(nullptr);
  Observer silent;
  const StaticPath path = find_static_path(system, {}, silent);
  const PeriodicSolution start(path.states.back().z, 0.0);
  return solve_or_settle(&start);
}

/// Tries a constant solution; an unbalanced rotor may have none.
std::optional<Trim> try_constant(const system::PeriodicSystem& system, const TrimOptions& options,
                                 MPI_Comm comm, const Trim* near) {
  try {
    const bool has_start = near != nullptr && near->solution.harmonics() == 0;
    return solve_harmonic_balance(system, 0, options.tolerance,
                                  has_start ? &near->solution : nullptr, comm);
  } catch (const ConvergenceError&) {
    return std::nullopt;
  }
}

/// Numbers of harmonics, each a third more than the one before and raised to the next closed one.
/// The work grows with H^2 to H^3: all attempts before a solution cost about as much as the
/// solution.
std::vector<int> harmonics_to_try(int least, int sectors) {
  std::vector<int> numbers;
  for (int next = std::max(1, least); next <= auto_harmonics;) {
    while (!is_closed(next, sectors)) ++next;
    if (next <= auto_harmonics) numbers.push_back(next);
    const int more = next + (next + 2) / 3;
    next = next < auto_harmonics ? std::min(more, auto_harmonics) : more;
  }
  return numbers;
}

/// Solves from the solution with fewer harmonics, or from the undeformed system where that does not
/// converge.
Trim solve_from(const system::PeriodicSystem& system, int harmonics, double tolerance,
                const std::optional<Trim>& last, MPI_Comm comm) {
  if (last) {
    try {
      return solve_harmonic_balance(system, harmonics, tolerance, &last->solution, comm);
    } catch (const ConvergenceError&) {
    }
  }
  return solve_harmonic_balance(system, harmonics, tolerance, nullptr, comm);
}

bool is_enough(const Trim& trim, const TrimOptions& options) {
  return trim.residual_between <= allowed_residual(trim, options.auto_tolerance) &&
         trim.state_residual <= options.auto_tolerance && trim.medium_residual <= rough_medium;
}

Trim raise_harmonics(const system::PeriodicSystem& system, const TrimOptions& options,
                     const std::optional<Trim>& constant, Observer& observer, MPI_Comm comm) {
  std::vector<std::pair<int, double>> attempts;
  if (constant) attempts = constant->attempts;
  std::optional<Trim> last;
  int failed = 0;
  std::exception_ptr failure;
  for (const int harmonics : harmonics_to_try(options.least_harmonics, system.symmetry().sectors)) {
    std::optional<Trim> solved;
    try {
      solved = solve_from(system, harmonics, options.tolerance, last, comm);
    } catch (const ConvergenceError&) {
      // More harmonics may have a solution where few have none.
      if (!failure) failure = std::current_exception();
      if (++failed == most_failures) std::rethrow_exception(failure);
      observer.note("trim: " + std::to_string(harmonics) + " harmonics, not converged");
      continue;
    }
    Trim& trim = *solved;
    attempts.emplace_back(harmonics, trim.residual_between);
    trim.attempts = attempts;
    std::ostringstream text;
    text << "trim: " << harmonics << " harmonics, residual between the samples "
         << trim.residual_between;
    observer.note(text.str());
    if (is_enough(trim, options)) return trim;
    last = std::move(trim);
  }
  if (!last) std::rethrow_exception(failure);
  throw ConvergenceError("trim: harmonics: auto reached " + std::to_string(auto_harmonics) +
                         " and the residual between the samples is still too large; hint: give "
                         "trim.harmonics or a larger trim.auto_tolerance");
}

/// Tries a steady state nearby as the start, with its harmonics.
std::optional<Trim> try_near(const system::PeriodicSystem& system, const TrimOptions& options,
                             MPI_Comm comm, const Trim* near) {
  if (near == nullptr || options.method != TrimMethod::harmonic_balance) return std::nullopt;
  const int harmonics = near->solution.harmonics();
  const int least = options.automatic ? std::max(1, options.least_harmonics) : options.harmonics;
  if (harmonics < least) return std::nullopt;
  try {
    const Residuals residuals = options.is_draft ? Residuals::none : Residuals::all;
    Trim trim = solve_harmonic_balance(system, harmonics, options.tolerance, &near->solution, comm,
                                       residuals);
    if (options.automatic && !options.is_draft && !is_enough(trim, options)) return std::nullopt;
    return trim;
  } catch (const ConvergenceError&) {
  } catch (const DomainError&) {
  }
  return std::nullopt;
}

}  // namespace

void add_held_loads(const system::PeriodicSystem& system, const std::vector<HeldCoordinate>& held,
                    Vec r) {
  if (held.empty()) return;
  const petsc::WriteView view(r);
  for (const HeldCoordinate& coordinate : held)
    for (const system::UnconstrainedCoordinate& unconstrained : system.unconstrained_coordinates())
      if (unconstrained.unknown == coordinate.unknown) view[unconstrained.row] += coordinate.load;
}

Trim find_trim(const system::PeriodicSystem& system, const TrimOptions& options, Observer& observer,
               MPI_Comm comm, const Trim* near) {
  const petsc::Stage stage("trim");
  require_roles(system);
  if (system.period() == 0.0) return solve_at_rest(system, options.tolerance, comm);
  // The state of a balanced rotor without gravity or tilt is constant in its own axes: a constant
  // is exact. Loads and motions that oscillate exclude a constant, but they might be zero at all of
  // its samples.
  const std::optional<Trim> constant = options.least_harmonics == 0 && !feels_time(system)
                                           ? try_constant(system, options, comm, near)
                                           : std::nullopt;
  if (constant && constant->residual_between <= allowed_residual(*constant, round_off) &&
      constant->residual <= allowed_residual(*constant, round_off) &&
      std::max(constant->state_residual, constant->medium_residual) <= state_round_off)
    return *constant;
  if (const std::optional<Trim> trim = try_near(system, options, comm, near)) return *trim;
  if (options.method == TrimMethod::shooting)
    return solve_shooting(system, options.steps, options.tolerance, observer);
  if (options.automatic) return raise_harmonics(system, options, constant, observer, comm);
  if (!is_closed(options.harmonics, system.symmetry().sectors))
    observer.note("trim: " + std::to_string(options.harmonics) + " harmonics leave harmonic " +
                  std::to_string(options.harmonics + 1) +
                  " of the fixed frame unbalanced; one more or one less is better");
  return solve_harmonic_balance(system, options.harmonics, options.tolerance, nullptr, comm);
}

}  // namespace samara::analysis
