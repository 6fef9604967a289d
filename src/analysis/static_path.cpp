#include "samara/analysis/static_path.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>

#include <Eigen/SVD>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"

#include "held_columns.hpp"

namespace samara::analysis {
namespace {

constexpr int most_newton_steps = 20;

/// After the first Newton steps, a correction this many times the one before counts as divergence.
constexpr double largest_growth = 10.0;
constexpr int patient_newton_steps = 3;

/// Largest number of halvings of a step before the analysis stops.
constexpr int most_halvings = 20;

/// A remainder of the load factor, or a motion [m, rad], that is round-off.
constexpr double round_off = 1e-12;

/// Cosine between the tangents at both ends of an arc; below it the step may have changed branches.
constexpr double least_cosine = 0.3;

/// Stiffness of free coordinates, relative to the stiffness that holds them at the start: only
/// loads restore coordinates with less than `weak`; nothing restores those with less than
/// `restored` under loads.
constexpr double weak = 1e-6;
constexpr double restored = 1e-8;

/// Relative to the largest internal load: smaller loads on free coordinates count as zero.
constexpr double unfelt = 1e-10;

/// Release of coordinates in parts: largest part, smallest part, and largest motion of a coordinate
/// in one part, relative to 1 [rad, m] plus its position.
constexpr double first_part = 0.125;
constexpr double least_part = 1e-6;
constexpr double longest_stride = 0.5;

/// A point of the path: the state and the load factor. In the state the load that holds an
/// unconstrained coordinate takes the place of this coordinate.
struct Point {
  Eigen::VectorXd x;
  double factor = 0.0;
};

/// Loads on free coordinates while they are released: in the row of each, remaining (load -
/// stiffness x), with the load that held it at x = 0.
struct Easing {
  std::vector<PetscInt> unknowns;
  std::vector<PetscInt> rows;
  Eigen::VectorXd loads;
  double stiffness = 0.0;  ///< [N/m, N m/rad]
  double remaining = 0.0;
};

/// r(x, f) = (1 - f) r_unloaded + f r_loaded, with its tangents and its solver. Held `coordinates`,
/// the unconstrained ones and others, stay at zero.
class Equilibrium {
 public:
  Equilibrium(const system::PeriodicSystem& system,
              std::vector<system::UnconstrainedCoordinate> coordinates, const Easing& easing)
      : loaded_(system),
        held_(std::move(coordinates)),
        easing_(easing),
        unloaded_(system.unloaded()),
        size_(static_cast<Eigen::Index>(system.size())),
        z_(system.make_state()),
        rest_(system.make_state()),
        r_(system.make_state()),
        jacobian_(system.make_jacobian()),
        unloaded_jacobian_(unloaded_->make_jacobian()),
        solver_("static_", equilibrate) {
    if (count_entries(jacobian_.get()) != count_entries(unloaded_jacobian_.get()))
      throw InternalError("the tangents with and without loads have entries in different places");
    for (Eigen::Index i = 0; i < size_; ++i) {
      const system::UnknownRole role = system.unknowns()[static_cast<std::size_t>(i)].role;
      if (role == system::UnknownRole::position) positions_.push_back(i);
      if (role == system::UnknownRole::internal) loads_.push_back(i);
      if (role == system::UnknownRole::state) states_.push_back(i);
    }
    for (const system::UnconstrainedCoordinate& held : held_) {
      std::erase(positions_, static_cast<Eigen::Index>(held.unknown));
      loads_.push_back(held.unknown);
    }
  }

  Point start() {
    loaded_.reference_state(0.0, z_.get());
    const petsc::ReadView view(z_.get());
    Point point;
    point.x = Eigen::Map<const Eigen::VectorXd>(view.data(), size_);
    for (const system::UnconstrainedCoordinate& held : held_) point.x(held.unknown) = 0.0;
    return point;
  }

  /// The residual, and its derivative by the factor.
  void evaluate(const Point& point, Eigen::VectorXd& r, Eigen::VectorXd& by_factor) {
    put(state_of(point.x));
    const Eigen::VectorXd without = residual_of(*unloaded_);
    const Eigen::VectorXd with = residual_of(loaded_);
    by_factor = with - without;
    r = (1.0 - point.factor) * without + point.factor * with;
    for (const system::UnconstrainedCoordinate& held : held_) r(held.row) += point.x(held.unknown);
    for (std::size_t n = 0; n < easing_.unknowns.size(); ++n) {
      const PetscInt at = easing_.unknowns[n];
      r(easing_.rows[n]) += easing_.remaining * (easing_.loads(static_cast<Eigen::Index>(n)) -
                                                 easing_.stiffness * point.x(at));
    }
  }

  /// Solves K columns = columns at a point.
  void solve(const Point& point, Eigen::MatrixXd& columns) {
    assemble(point);
    hold_coordinates(jacobian_.get(), held_);
    solver_.factor(jacobian_.get());
    solver_.solve(columns);
  }

  /// Stiffness of the rest of the turbine against displacements of some of the held coordinates.
  Eigen::MatrixXd stiffness_of(const Point& point, const std::vector<PetscInt>& coordinates) {
    assemble(point);
    const Eigen::SparseMatrix<double> K = to_sparse(jacobian_.get());
    const auto n = static_cast<Eigen::Index>(coordinates.size());
    Eigen::MatrixXd columns(size_, n);
    for (Eigen::Index j = 0; j < n; ++j)
      columns.col(j) = -K.col(coordinates[static_cast<std::size_t>(j)]);
    solve(point, columns);
    return at(columns, coordinates);
  }

  /// Motions of the coordinates that are being released, under a unit load on each of them.
  Eigen::MatrixXd eased_compliance(const Point& point) {
    const auto n = static_cast<Eigen::Index>(easing_.rows.size());
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(size_, n);
    for (Eigen::Index j = 0; j < n; ++j)
      columns(easing_.rows[static_cast<std::size_t>(j)], j) = 1.0;
    solve(point, columns);
    return at(columns, easing_.unknowns);
  }

  /// The system with large rotations counted from their present values; the point is rewritten for
  /// it. Null where no rotation is large.
  std::unique_ptr<system::PeriodicSystem> counted_from(Point& point) {
    put(state_of(point.x));
    std::unique_ptr<system::PeriodicSystem> system = loaded_.counted_from(z_.get());
    if (!system) return system;
    std::vector<double> loads;
    for (const system::UnconstrainedCoordinate& held : held_)
      loads.push_back(point.x(held.unknown));
    const petsc::ReadView view(z_.get());
    point.x = Eigen::Map<const Eigen::VectorXd>(view.data(), size_);
    for (std::size_t n = 0; n < loads.size(); ++n) point.x(held_[n].unknown) = loads[n];
    return system;
  }

  /// Loads that hold coordinates; each is the residual of the row of its coordinate.
  std::vector<HeldCoordinate> held_loads(const Point& point) const {
    std::vector<HeldCoordinate> held;
    for (const system::UnconstrainedCoordinate& unconstrained : held_)
      held.push_back({unconstrained.name, unconstrained.unit, point.x(unconstrained.unknown),
                      unconstrained.unknown});
    return held;
  }

  Eigen::VectorXd state_of(Eigen::VectorXd x) const {
    for (const system::UnconstrainedCoordinate& held : held_) x(held.unknown) = 0.0;
    return x;
  }

  /// The result counts rotations from the undeformed state.
  StaticState describe(const Point& point, int newton_steps) {
    Eigen::VectorXd r;
    Eigen::VectorXd by_factor;
    evaluate(point, r, by_factor);
    StaticState state{point.factor, {}, newton_steps, 0.0};
    loaded_.require_admissible(0.0, z_.get());
    loaded_.count_from_undeformed(z_.get());
    {
      const petsc::ReadView view(z_.get());
      state.z = Eigen::Map<const Eigen::VectorXd>(view.data(), size_);
    }
    for (Eigen::Index i = 0; i < size_; ++i)
      if (loaded_.rows()[static_cast<std::size_t>(i)] == system::RowRole::balance)
        state.residual = std::max(state.residual, std::abs(r(i)));
    return state;
  }

  /// Largest change relative to the largest value, of positions and of internal loads, and of
  /// first-order states relative to their own value or scale. Rigid parts move by round-off
  /// only. `applied`: size of the applied loads [N, N m]; without loads, in a medium that does not
  /// act yet, internal loads are round-off.
  double relative_change(const Eigen::VectorXd& change, const Eigen::VectorXd& x,
                         double applied) const {
    double worst = 0.0;
    for (const std::vector<Eigen::Index>* unknowns : {&positions_, &loads_}) {
      double moved = 0.0;
      double size = 0.0;
      for (const Eigen::Index i : *unknowns) {
        moved = std::max(moved, std::abs(change(i)));
        size = std::max(size, std::abs(x(i)));
      }
      if (!(moved <= std::numeric_limits<double>::max())) return moved;
      if (moved > (unknowns == &positions_ ? round_off : 0.0))
        worst =
            std::max(worst, moved / std::max({size, moved, unknowns == &loads_ ? applied : 0.0}));
    }
    for (const Eigen::Index i : states_) {
      const double scale = loaded_.unknowns()[static_cast<std::size_t>(i)].scale;
      const double moved = std::abs(change(i)) / std::max(std::abs(x(i)), scale);
      if (!(moved <= std::numeric_limits<double>::max())) return moved;
      worst = std::max(worst, moved);
    }
    return worst;
  }

  /// Largest internal load, in absolute value [N, N m].
  double load_level(const Point& point) const {
    double largest = 0.0;
    for (const Eigen::Index i : loads_) largest = std::max(largest, std::abs(point.x(i)));
    return largest;
  }

  /// Product over the positions only.
  double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    double sum = 0.0;
    for (const Eigen::Index i : positions_) sum += a(i) * b(i);
    return sum;
  }

 private:
  void put(const Eigen::VectorXd& z) {
    const petsc::WriteView view(z_.get());
    Eigen::Map<Eigen::VectorXd>(view.data(), size_) = z;
  }

  Eigen::VectorXd residual_of(const system::PeriodicSystem& system) {
    system.residual(0.0, z_.get(), rest_.get(), r_.get());
    const petsc::ReadView view(r_.get());
    return Eigen::Map<const Eigen::VectorXd>(view.data(), size_);
  }

  static Eigen::MatrixXd at(const Eigen::MatrixXd& columns, const std::vector<PetscInt>& rows) {
    Eigen::MatrixXd picked(static_cast<Eigen::Index>(rows.size()), columns.cols());
    for (std::size_t i = 0; i < rows.size(); ++i)
      picked.row(static_cast<Eigen::Index>(i)) = columns.row(rows[i]);
    return picked;
  }

  static double count_entries(Mat matrix) {
    MatInfo info;
    petsc::check(MatGetInfo(matrix, MAT_GLOBAL_SUM, &info));
    return info.nz_used;
  }

  /// Assembles the tangent, with the springs on the coordinates that are being released.
  void assemble(const Point& point) {
    put(state_of(point.x));
    loaded_.tangents(0.0, z_.get(), rest_.get(), 0.0, jacobian_.get(), nullptr);
    if (point.factor != 1.0) {
      unloaded_->tangents(0.0, z_.get(), rest_.get(), 0.0, unloaded_jacobian_.get(), nullptr);
      petsc::check(MatScale(jacobian_.get(), point.factor));
      petsc::check(MatAXPY(jacobian_.get(), 1.0 - point.factor, unloaded_jacobian_.get(),
                           SAME_NONZERO_PATTERN));
    }
    if (easing_.remaining == 0.0) return;
    for (std::size_t n = 0; n < easing_.unknowns.size(); ++n)
      petsc::check(MatSetValue(jacobian_.get(), easing_.rows[n], easing_.unknowns[n],
                               -easing_.remaining * easing_.stiffness, ADD_VALUES));
    petsc::check(MatAssemblyBegin(jacobian_.get(), MAT_FINAL_ASSEMBLY));
    petsc::check(MatAssemblyEnd(jacobian_.get(), MAT_FINAL_ASSEMBLY));
  }

  const system::PeriodicSystem& loaded_;
  std::vector<system::UnconstrainedCoordinate> held_;
  const Easing& easing_;
  std::unique_ptr<system::PeriodicSystem> unloaded_;
  Eigen::Index size_;
  petsc::Handle<Vec> z_;
  petsc::Handle<Vec> rest_;  ///< zero rates
  petsc::Handle<Vec> r_;
  petsc::Handle<Mat> jacobian_;
  petsc::Handle<Mat> unloaded_jacobian_;
  DirectSolver solver_;
  std::vector<Eigen::Index> positions_;
  std::vector<Eigen::Index> loads_;  ///< internal, and those that hold coordinates
  std::vector<Eigen::Index> states_;
};

/// Change along the path per unit of arc length: ds^2 = |positions|^2 / D^2 + df^2 / f0^2, with f0
/// the first step of the factor and D the length of the first step of the positions.
struct Direction {
  Eigen::VectorXd x;
  double factor = 0.0;
};

class PathFollower {
 public:
  PathFollower(const system::PeriodicSystem& system, const StaticOptions& options,
               Observer& observer)
      : system_(system),
        options_(options),
        observer_(observer),
        free_(system.free_coordinates()),
        equilibrium_(make_equilibrium(system)) {
    path_.method = options.method;
    first_step_ = 1.0 / options.steps;
  }

  StaticPath run() {
    Point point = equilibrium_->start();
    if (!release(point) && !attempt([&] { accept(point, correct(point, nullptr)); })) give_up();
    if (options_.method == StaticMethod::load)
      follow_loads(point);
    else
      follow_arc(point);
    finish(point);
    return std::move(path_);
  }

 private:
  // ---- one step ------------------------------------------------------------------------------

  /// Newton's method at a given factor or, with a direction, in the plane through the point that is
  /// perpendicular to the direction. Returns the number of steps.
  int correct(Point& point, const Direction* across) {
    double last = std::numeric_limits<double>::infinity();
    for (int step = 1; step <= most_newton_steps; ++step) {
      Eigen::VectorXd r;
      Eigen::VectorXd by_factor;
      equilibrium_->evaluate(point, r, by_factor);
      Eigen::MatrixXd columns(r.size(), across == nullptr ? 1 : 2);
      columns.col(0) = -r;
      if (across != nullptr) columns.col(1) = -by_factor;
      equilibrium_->solve(point, columns);
      Eigen::VectorXd change = columns.col(0);
      if (across != nullptr) {  // elimination of the border
        const double factor_change =
            -product(*across, {columns.col(0), 0.0}) / product(*across, {columns.col(1), 1.0});
        change += factor_change * columns.col(1);
        point.factor += factor_change;
      }
      point.x += change;
      const double size =
          equilibrium_->relative_change(change, point.x, by_factor.lpNorm<Eigen::Infinity>());
      if (size <= options_.tolerance) return step;
      if (!std::isfinite(size) || (step > patient_newton_steps && size > largest_growth * last))
        throw ConvergenceError("Newton's iteration diverges");
      last = size;
    }
    throw ConvergenceError("Newton's iteration does not converge in " +
                           std::to_string(most_newton_steps) + " steps");
  }

  /// False where a step failed: a rotation out of range, no convergence, a singular matrix.
  template <class Step>
  bool attempt(const Step& step) {
    if (++tried_ > options_.most_steps) {
      failure_ = std::make_exception_ptr(ConvergenceError(
          std::to_string(options_.most_steps) + " steps (static.max_steps) were not enough"));
      give_up();
    }
    try {
      step();
      return true;
    } catch (const DomainError&) {
      failure_ = std::current_exception();
    } catch (const ConvergenceError&) {
      failure_ = std::current_exception();
    }
    return false;
  }

  void cut() {
    ++path_.cuts;
    if (++halvings_ > most_halvings) give_up();
  }

  /// Adds a point in equilibrium to the path. Its residual is evaluated, which may find a rotation
  /// out of range.
  void accept(const Point& point, int newton_steps) {
    path_.states.push_back(equilibrium_->describe(point, newton_steps));
    constexpr long parts = 1000;
    observer_.progress("static", std::lround(std::clamp(point.factor, 0.0, 1.0) * parts), parts);
  }

  [[noreturn]] void give_up() const {
    std::ostringstream text;
    text << "static: ";
    if (path_.states.empty())
      text << "no equilibrium without loads: ";
    else
      text << "stopped at load factor " << path_.states.back().factor << " of 1: ";
    try {
      std::rethrow_exception(failure_);
    } catch (const DomainError& error) {
      text << error.what() << "; hint: smaller loads, or a stiffer beam";
      throw DomainError(text.str());
    } catch (const SingularError& error) {
      text << error.what() << "; hint: ";
      if (path_.states.empty()) throw InputError(text.str() + unheld_words());
      text << load_hint();
      throw ConvergenceError(text.str());
    } catch (const ConvergenceError& error) {
      const std::string words = error.what();
      text << words;
      if (words.find("; hint: ") == std::string::npos) text << "; hint: " << load_hint();
      throw ConvergenceError(text.str());
    }
  }

  std::string unheld_words() const {
    std::string names;
    for (const system::UnconstrainedCoordinate& free : free_)
      names += (names.empty() ? " (" : ", ") + free.name;
    return "a coordinate may move that nothing holds" + (names.empty() ? "" : names + ")") +
           ", or a part is held twice";
  }

  const char* load_hint() const {
    if (tried_ > options_.most_steps)
      return "a larger static.max_steps; the path may never reach the full loads";
    if (options_.method == StaticMethod::load)
      return "more static.steps; static.method: arc_length where the load cannot rise further";
    return "more static.steps, or a finer mesh";
  }

  /// Counts large rotations from their present values, so that the next step may turn as far again.
  /// The point is corrected, because the solution on a coarse mesh depends a little on the
  /// reference of the rotations. True where the point has been rewritten.
  bool recount(Point& point) {
    Point anew = point;
    std::unique_ptr<system::PeriodicSystem> system = equilibrium_->counted_from(anew);
    if (!system) return false;
    auto other = make_equilibrium(*system);
    std::swap(equilibrium_, other);
    try {
      correct(anew, nullptr);
    } catch (const DomainError&) {
      std::swap(equilibrium_, other);
      return false;
    } catch (const ConvergenceError&) {  // for example at a limit point
      std::swap(equilibrium_, other);
      return false;
    }
    other.reset();  // before the system that it refers to
    recounted_ = std::move(system);
    point = anew;
    return true;
  }

  // ---- free coordinates -----------------------------------------------------------------------

  std::unique_ptr<Equilibrium> make_equilibrium(const system::PeriodicSystem& system) const {
    return std::make_unique<Equilibrium>(system, system.unconstrained_coordinates(), easing_);
  }

  std::vector<PetscInt> free_unknowns() const {
    std::vector<PetscInt> unknowns;
    for (const system::UnconstrainedCoordinate& free : free_) unknowns.push_back(free.unknown);
    return unknowns;
  }

  /// Points with free coordinates held at zero: one without loads, and one with the loads of the
  /// first step.
  struct Held {
    Point rest;
    Point loaded;
    Eigen::MatrixXd bare;       ///< stiffness that restores the free directions without loads
    Eigen::MatrixXd stiffness;  ///< the same under loads
    int newton_steps = 0;
  };

  /// Empty where the coordinates cannot be held, because the beam would be held twice.
  std::optional<Held> hold_free() {
    std::vector<system::UnconstrainedCoordinate> coordinates = system_.unconstrained_coordinates();
    coordinates.insert(coordinates.end(), free_.begin(), free_.end());
    Equilibrium& equilibrium =
        *(equilibrium_ = std::make_unique<Equilibrium>(system_, coordinates, easing_));
    Held held;
    held.rest = equilibrium.start();
    if (!attempt([&] { held.bare = equilibrium.stiffness_of(held.rest, free_unknowns()); }))
      return {};
    for (double factor = first_step_; factor > round_off; factor *= 0.5) {
      held.loaded = held.rest;
      held.loaded.factor = factor;
      const bool found = attempt([&] {
        held.newton_steps = correct(held.loaded, nullptr);
        held.stiffness = equilibrium.stiffness_of(held.loaded, free_unknowns());
      });
      if (found) return held;
    }
    return {};
  }

  /// A hinge that only loads restore turns as soon as loads act: at load factor 0 the tangent is
  /// singular. The path therefore starts at the first step; the supports are held there and then
  /// released. False where that is not needed or not possible.
  bool release(Point& point) {
    if (free_.empty()) return false;
    const std::optional<Held> held = hold_free();
    const double level = held ? equilibrium_->load_level(held->loaded) : 0.0;
    equilibrium_ = make_equilibrium(system_);
    if (!held) return false;
    easing_.loads = held->loaded.x(free_unknowns());
    easing_.stiffness =
        easing_.loads.cwiseAbs().maxCoeff() + 2.0 * (held->stiffness - held->bare).norm();
    const bool is_loaded = easing_.stiffness > unfelt * level;
    const Eigen::JacobiSVD<Eigen::MatrixXd> bare(held->bare, Eigen::ComputeFullV);
    const double least = bare.singularValues().tail<1>()(0);
    if (least > (is_loaded ? weak * easing_.stiffness : unfelt * level)) return false;
    if (!is_loaded) refuse_unrestored(bare.matrixV().rightCols<1>());
    accept(held->rest, 1);
    easing_.unknowns = free_unknowns();
    easing_.rows.clear();
    for (const system::UnconstrainedCoordinate& free : free_) easing_.rows.push_back(free.row);
    easing_.remaining = 1.0;
    point = held->loaded;
    point.x(easing_.unknowns).setZero();
    const int newton_steps = held->newton_steps + set_free(point);
    accept(point, newton_steps);
    return true;
  }

  /// Reduces the loads that hold free coordinates, and a spring on each of them, to zero at a
  /// constant load factor. The springs keep the path away from other branches. Returns the number
  /// of Newton steps.
  int set_free(Point& point) {
    int newton_steps = 0;
    const bool at_once = easing_.loads.cwiseAbs().maxCoeff() <= round_off * easing_.stiffness;
    const double most = at_once ? 1.0 : first_part;
    double part = most;
    while (easing_.remaining > 0.0) {
      const double before = easing_.remaining;
      easing_.remaining = before - part > round_off ? before - part : 0.0;
      Point next = point;
      if (attempt([&] {
            newton_steps += correct(next, nullptr);
            refuse_leap(point, next);
          })) {
        point = next;
        recount(point);
        part = std::min(2.0 * part, most);
        continue;
      }
      easing_.remaining = before;
      part *= 0.5;
      ++path_.cuts;
      if (part > least_part) continue;
      require_restored(point);
      give_up();
    }
    require_restored(point);
    return newton_steps;
  }

  void refuse_leap(const Point& point, const Point& next) const {
    for (const PetscInt at : easing_.unknowns)
      if (std::abs(next.x(at) - point.x(at)) > longest_stride * (1.0 + std::abs(point.x(at))))
        throw ConvergenceError("a released coordinate moves too far in one step");
  }

  /// Checks that turbine and loads restore the free directions, with very soft springs added.
  void require_restored(const Point& point) {
    const double remaining = easing_.remaining;
    easing_.remaining = restored;
    const Eigen::MatrixXd motions = equilibrium_->eased_compliance(point);
    easing_.remaining = remaining;
    const Eigen::JacobiSVD<Eigen::MatrixXd> values(motions, Eigen::ComputeThinU);
    if (values.singularValues()(0) * restored * easing_.stiffness > 0.5)
      refuse_unrestored(values.matrixU().leftCols<1>());
  }

  [[noreturn]] void refuse_unrestored(const Eigen::VectorXd& motion) const {
    std::string names;
    for (std::size_t n = 0; n < free_.size(); ++n)
      if (std::abs(motion(static_cast<Eigen::Index>(n))) > 0.1 * motion.cwiseAbs().maxCoeff())
        names += (names.empty() ? "" : ", ") + free_[n].name;
    throw InputError("static: nothing restores " + names +
                     ", which is free: no load, no spring, no other support; hint: give it a "
                     "stiffness");
  }

  // ---- prescribed factors --------------------------------------------------------------------

  /// Newton's method may end on another branch of equilibria. Then the motion of the step is
  /// opposite to the tangent at its start or at its end.
  void refuse_jump(const Point& point, const Direction& slope, const Point& next,
                   const Direction& next_slope) const {
    const Eigen::VectorXd motion = next.x - point.x;
    if (std::sqrt(equilibrium_->product(motion, motion)) < round_off) return;
    if (equilibrium_->product(motion, slope.x) < 0.0 ||
        equilibrium_->product(motion, next_slope.x) < 0.0)
      throw ConvergenceError("the state jumps, or turns back: there may be another branch");
  }

  void follow_loads(Point& point) {
    double step = first_step_;
    Direction slope = slope_at(point);
    while (point.factor < 1.0) {
      // Cut steps, too, end at the next multiple of the first step.
      const double multiple =
          (std::floor(point.factor / first_step_ + round_off) + 1.0) * first_step_;
      Point next = point;
      next.factor = std::min(point.factor + step, multiple);
      if (next.factor > 1.0 - round_off) next.factor = 1.0;
      Direction next_slope;
      const bool found = attempt([&] {
        const int newton_steps = correct(next, nullptr);
        next_slope = slope_at(next);
        refuse_jump(point, slope, next, next_slope);
        accept(next, newton_steps);
      });
      if (found) {
        point = next;
        slope = recount(point) ? slope_at(point) : next_slope;
        halvings_ = std::max(halvings_ - 1, 0);
        step = std::min(2.0 * step, first_step_);
      } else {
        step *= 0.5;
        cut();
      }
    }
  }

  // ---- arc length ----------------------------------------------------------------------------

  double product(const Direction& a, const Direction& b) const {
    return equilibrium_->product(a.x, b.x) / (length_ * length_) +
           a.factor * b.factor / (first_step_ * first_step_);
  }

  /// dx/df along the path.
  Direction slope_at(const Point& point) {
    Eigen::VectorXd r;
    Eigen::VectorXd by_factor;
    equilibrium_->evaluate(point, r, by_factor);
    Eigen::MatrixXd columns = -by_factor;
    equilibrium_->solve(point, columns);
    return {columns.col(0), 1.0};
  }

  /// The unit tangent with a positive component along `before`.
  Direction tangent_at(const Point& point, const Direction& before) {
    Direction tangent = slope_at(point);
    const double along = product(before, tangent);
    const double scale = std::copysign(1.0 / std::sqrt(product(tangent, tangent)), along);
    tangent.x *= scale;
    tangent.factor *= scale;
    return tangent;
  }

  void follow_arc(Point& point) {
    Direction tangent = slope_at(point);
    length_ = first_step_ * std::sqrt(equilibrium_->product(tangent.x, tangent.x));
    if (length_ < round_off) return follow_loads(point);  // nothing moves
    tangent = tangent_at(point, tangent);
    const double largest = first_step_ / tangent.factor;
    double step = largest;
    while (point.factor < 1.0) {
      Point next{point.x + step * tangent.x, point.factor + step * tangent.factor};
      Direction ahead;
      const bool found = attempt([&] {
        int newton_steps = correct(next, &tangent);
        if (next.factor >= 1.0) {  // the end of the path is within this step
          const double part = (1.0 - point.factor) / (next.factor - point.factor);
          next = {point.x + part * (next.x - point.x), 1.0};
          newton_steps += correct(next, nullptr);
        }
        ahead = tangent_at(next, tangent);
        if (product(tangent, ahead) < least_cosine)
          throw ConvergenceError("the path bends too sharply, or changes to another branch");
        accept(next, newton_steps);
      });
      if (!found) {
        step *= 0.5;
        cut();
        continue;
      }
      if (ahead.factor * tangent.factor < 0.0) note_limit_point(point, next, tangent);
      point = next;
      tangent = recount(point) ? tangent_at(point, ahead) : ahead;
      halvings_ = std::max(halvings_ - 1, 0);
      step = std::min(2.0 * step, largest);
    }
  }

  void note_limit_point(const Point& before, const Point& behind, const Direction& tangent) {
    const double factor = tangent.factor > 0.0 ? std::max(before.factor, behind.factor)
                                               : std::min(before.factor, behind.factor);
    path_.limit_points.push_back(factor);
    std::ostringstream text;
    text << "static: limit point near load factor " << factor << "; beyond it the load factor "
         << (tangent.factor > 0.0 ? "falls" : "rises");
    observer_.note(text.str());
  }

  void finish(const Point& point) {
    const StaticState& last = path_.states.back();
    for (std::size_t i = 0; i < system_.unknowns().size(); ++i)
      if (system_.unknowns()[i].role == system::UnknownRole::internal)
        path_.load_level =
            std::max(path_.load_level, std::abs(last.z(static_cast<Eigen::Index>(i))));
    path_.held = equilibrium_->held_loads(point);
  }

  const system::PeriodicSystem& system_;
  const StaticOptions& options_;
  Observer& observer_;
  std::vector<system::UnconstrainedCoordinate> free_;  ///< coordinates without springs
  Easing easing_;                                      ///< while they are released
  std::unique_ptr<system::PeriodicSystem> recounted_;  ///< with rotations counted anew
  std::unique_ptr<Equilibrium> equilibrium_;           ///< of recounted_, or of the system itself
  StaticPath path_;
  double first_step_ = 1.0;  ///< of the factor
  double length_ = 1.0;      ///< D
  long tried_ = 0;
  int halvings_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

StaticPath find_static_path(const system::PeriodicSystem& system, const StaticOptions& options,
                            Observer& observer) {
  if (system.period() != 0.0)
    throw InputError("static: the rotor turns; hint: samara trim, or --set shaft.speed=0");
  return PathFollower(system, options, observer).run();
}

}  // namespace samara::analysis
