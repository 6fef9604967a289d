#include "samara/analysis/transient.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <optional>
#include <sstream>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/petsc/options.hpp"
#include "samara/petsc/session.hpp"
#include "samara/system/angles.hpp"

#include "admissible_velocities.hpp"
#include "matrix_entries.hpp"
#include "mesh_partition.hpp"
#include "partition_factors.hpp"

namespace samara::analysis {
namespace {

/// Types of TS that suit this system, with the orders of docs/theory.md, section 9.1.
constexpr std::array<const char*, 5> sound_types{TSBDF, TSTHETA, TSCN, TSALPHA, TSBEULER};
/// Highest stable order of BDF with rigid strains (docs/theory.md, section 9.1).
constexpr PetscInt most_stable_order = 2;
/// Newton's method keeps an old tangent while each step reduces the residual to this part or less.
constexpr double slow_contraction = 0.1;
/// Number of steps after a start in which the factor of M differs from step to step.
constexpr int starting_steps = 3;
/// Ratio of a step to the one before: BDF2 is stable up to 2.4.
constexpr double largest_growth = 2.0;
constexpr double least_growth = 0.1;
/// A tolerance that no error reaches.
constexpr double left_out = 1e30;
/// Relative to the state: smaller corrections that no longer shrink are round-off.
constexpr double stagnation = 1e-8;
constexpr double round_off = 1e-9;
/// Relative to the step: the first step of BDF2, which is of first order. Each later step may be
/// twice as long as the one before. This reduces the error of the start to a thousandth.
constexpr double first_step = 1.0 / 32.0;
constexpr int most_newton_steps = 20;
/// Largest difference of an angle at the end of a step from the value that its rate predicts [rad].
/// The equations of a step have other solutions, whole turns away or with a hinge folded back.
constexpr double largest_deviation = 0.1;
/// Step that finds the rates at the start, relative to a step of the simulation.
constexpr double start_fraction = 1e-3;
constexpr int start_iterations = 4;

/// The ranks over which the mesh is distributed, if it is large. The midpoint rule, and options of
/// a solver of PETSc, need the whole mesh on one rank.
MPI_Comm ranks_for(const TransientOptions& options, MPI_Comm comm) {
  const std::string given = petsc::Session::options();
  for (const char* option : {"-transient_ts_type", "-transient_pc_", "-transient_mat_"})
    if (given.find(option) != std::string::npos) return PETSC_COMM_SELF;
  return options.method == TransientMethod::bdf2 ? comm : PETSC_COMM_SELF;
}

/// The equations for TS, and the control of TS from one instant of the grid to the next. Vectors of
/// TS have the unknowns that the ranks count. `z_`, `z_dot_`, `r_` and the scaling have places for
/// all unknowns, with values for those on this rank.
class Integration {
 public:
  Integration(const system::PeriodicSystem& system, const TransientStart& start,
              const TransientOptions& options, TransientObserver& observer, MPI_Comm comm)
      : whole_(system),
        partition_(system, {}, false, ranks_for(options, comm)),
        system_(partition_.system()),
        options_(options),
        observer_(observer),
        start_(start),
        origin_(start.origin),
        step_(start.step),
        last_step_(
            static_cast<long>(std::ceil(options.duration / options.step * (1.0 - round_off)))),
        z_(system.make_state()),
        z_dot_(system.make_state()),
        r_(system.make_state()),
        jacobian_(system_.make_jacobian()) {
    for (const petsc::Handle<Vec>* vector : {&z_, &z_dot_, &r_})
      petsc::check(VecSet(vector->get(), 0.0));
    scale_system();
    find_angles();
    const auto counted = static_cast<PetscInt>(partition_.counted().size());
    x_ = petsc::make_vector(partition_.ranks().comm, counted, PETSC_DETERMINE);
    petsc::check(VecDuplicate(x_.get(), before_.fill()));
    if (partition_.is_distributed()) {
      runs_ = partition_.runs();
      border_ = partition_.border_unknowns();
      whole_z_ = system.make_state();
      whole_z_dot_ = system.make_state();
    }
    write_state(start.z);
    make_integrator(start.time);
    limit_ = start_limit();
    begin_midpoint();
  }

  TransientRun run() {
    const petsc::Stage stage("transient");
    if (start_.time == origin_ && start_.is_row && !sample_start()) {
      TransientRun run;
      run.end = state();
      run.reason = TransientEnd::observer;
      return run;
    }
    const PetscErrorCode code = TSSolve(ts_.get(), x_.get());
    if (code != 0 && error_) std::rethrow_exception(error_);
    petsc::check(code);
    TSConvergedReason reason = TS_CONVERGED_ITERATING;
    petsc::check(TSGetConvergedReason(ts_.get(), &reason));
    if (reason < 0) fail(TSConvergedReasons[reason]);
    TransientRun run;
    run.end = state();
    run.before = point_of(before_.get());
    run.before.time = time_before_;
    run.before.step = step_before_;
    run.reason = reason_;
    TSType type = nullptr;
    petsc::check(TSGetType(ts_.get(), &type));
    run.method = type;
    if (run.method == TSBDF) {
      PetscInt order = 0;
      petsc::check(TSBDFGetOrder(ts_.get(), &order));
      run.method += std::to_string(order);
    }
    run.steps = steps_;
    run.ranks = partition_.ranks().size;
    run.newton_steps = newton_steps_;
    run.factorizations = factorizations_;
    run.cuts = cuts_;
    return run;
  }

 private:
  /// A coordinate that turns.
  struct Angle {
    PetscInt unknown = 0;
    double value = 0.0;  ///< before the step
    double rate = 0.0;   ///< of the step before [1/s]
  };

  // ---- the system, scaled ----------------------------------------------------------------------

  void scale_system() {
    const double shift = 1.5 / options_.step;
    whole_.reference_state(origin_, z_.get());
    system_.tangents(origin_, z_.get(), z_dot_.get(), shift, jacobian_.get(), nullptr);
    scaling_ = scaling_of(jacobian_.get(), 1.0 / options_.step);
    round_to_powers_of_two(scaling_);
  }

  Equilibration scaling_of(Mat tangent, double rate) const {
    return scaling_by_role(system_, to_sparse(tangent), rate, 0.0, &partition_.ranks());
  }

  void find_angles() {
    for (std::size_t i = 0; i < system_.unknowns().size(); ++i)
      if (system::is_angle(system_.unknowns()[i])) angles_.push_back({static_cast<PetscInt>(i)});
    begin_angles(start_.z_dot);
  }

  /// Replaces the earlier rates, so that the further run depends on the state of a start, or of a
  /// checkpoint, alone. Rates may be unknown.
  void begin_angles(const Eigen::VectorXd& z_dot) {
    has_rates_ = z_dot.size() > 0;
    if (!has_rates_) return;
    for (Angle& angle : angles_) angle.rate = z_dot(angle.unknown);
  }

  /// Notes the angles at the start of a step.
  void note_angles() {
    unscale(before_.get(), r_.get());
    const petsc::ReadView view(r_.get());
    for (Angle& angle : angles_) angle.value = view[angle.unknown];
  }

  /// Notes the rates at the end of a step. With BDF the equations contain these rates. With other
  /// methods the equations contain other rates (twice the rate in the trapezoidal rule); the mean
  /// over the step is used instead.
  void note_rates(double taken) {
    const bool has_rates = is_bdf();
    if (!has_rates) unscale(x_.get(), r_.get());
    const petsc::ReadView rates(z_dot_.get());
    const petsc::ReadView ends(r_.get());
    for (Angle& angle : angles_)
      angle.rate = has_rates ? rates[angle.unknown] : (ends[angle.unknown] - angle.value) / taken;
    has_rates_ = true;
  }

  /// Whether the solution of a step, at the last residual, continues the steps before.
  bool goes_on() {
    if (!has_rates_) return true;
    try {
      partition_.ranks().attempt([this] { require_small_deviations(); });
    } catch (...) {
      error_ = std::current_exception();
      return false;
    }
    return true;
  }

  void require_small_deviations() const {
    const petsc::ReadView view(z_.get());
    for (const Angle& angle : angles_) {
      if (partition_.number_of(angle.unknown) < 0) continue;
      const system::Unknown& unknown = system_.unknowns()[static_cast<std::size_t>(angle.unknown)];
      const double value = view[angle.unknown];
      const double deviation = (value - angle.value - (t_ - time_before_) * angle.rate) /
                               system::angle_stretch(unknown, value);
      if (std::abs(deviation) <= largest_deviation) continue;
      throw DomainError(unknown.name() + " is " + general(deviation, 4) +
                        " rad from the angle that its rate predicts");
    }
  }

  void write_state(const Eigen::VectorXd& z) {
    const petsc::ReadView factors(scaling_.columns.get());
    const petsc::WriteView view(x_.get());
    const std::vector<PetscInt>& counted = partition_.counted();
    for (std::size_t i = 0; i < counted.size(); ++i) {
      const PetscInt unknown = partition_.kept()[static_cast<std::size_t>(counted[i])];
      view[static_cast<PetscInt>(i)] = z(unknown) / factors[unknown];
    }
  }

  /// z of the scaled state `x`, with the unknowns of all ranks.
  Eigen::VectorXd read_state(Vec x) const {
    unscale(x, r_.get());
    return values_of(r_.get());
  }

  /// The unknowns of all ranks, from a vector with those on each rank.
  Eigen::VectorXd values_of(Vec vector) const {
    const petsc::ReadView view(vector);
    const Eigen::Map<const Eigen::RowVectorXd> values(view.data(), system_.size());
    if (!partition_.is_distributed()) return values.transpose();
    return partition_.whole(partition_.local(values)).transpose();
  }

  /// The same in place of a vector: itself where this rank has all unknowns.
  Vec gathered(Vec vector, const petsc::Handle<Vec>& whole) const {
    if (!partition_.is_distributed()) return vector;
    put(values_of(vector), whole.get());
    return whole.get();
  }

  TransientStart state() {
    TransientStart point = point_of(x_.get());
    petsc::check(TSGetTime(ts_.get(), &point.time));
    point.step = step_;
    if (steps_ > 0 && std::abs(t_ - point.time) <= round_off * options_.step) {
      point.z_dot = values_of(z_dot_.get());
    }
    return point;
  }

  /// Point with the scaled state `x`; its time is not set.
  TransientStart point_of(Vec x) {
    TransientStart point;
    point.origin = origin_;
    point.z = read_state(x);
    point.held = start_.held;
    return point;
  }

  using Values = Eigen::Map<Eigen::ArrayXd>;
  using ConstValues = Eigen::Map<const Eigen::ArrayXd>;

  /// z = columns x.
  void unscale(Vec x, Vec z) const {
    if (!partition_.is_distributed()) {
      petsc::check(VecPointwiseMult(z, x, scaling_.columns.get()));
      return;
    }
    {
      const petsc::ReadView from(x);
      const petsc::ReadView factors(scaling_.columns.get());
      const petsc::WriteView to(z);
      if (!partition_.is_first())
        for (const PetscInt unknown : border_) to[unknown] = 0.0;
      for (const MeshPartition::Run& run : runs_)
        Values(to.data() + run.unknown, run.count) =
            ConstValues(from.data() + run.counted, run.count) *
            ConstValues(factors.data() + run.unknown, run.count);
    }
    sum_border(z);
  }

  /// Adds up the values of the border, of which each rank has a part.
  void sum_border(Vec vector) const {
    const petsc::WriteView values(vector);
    Eigen::VectorXd border(static_cast<Eigen::Index>(border_.size()));
    for (std::size_t i = 0; i < border_.size(); ++i)
      border(static_cast<Eigen::Index>(i)) = values[border_[i]];
    partition_.ranks().sum(border);
    for (std::size_t i = 0; i < border_.size(); ++i)
      values[border_[i]] = border(static_cast<Eigen::Index>(i));
  }

  void residual(double t, Vec x, Vec x_dot, Vec f) {
    unscale(x, z_.get());
    unscale(x_dot, z_dot_.get());
    t_ = t;
    if (partition_.is_distributed()) {
      find_residual_on_rank(t);
      const petsc::ReadView from(r_.get());
      const petsc::ReadView factors(scaling_.rows.get());
      const petsc::WriteView to(f);
      for (const MeshPartition::Run& run : runs_)
        Values(to.data() + run.counted, run.count) =
            ConstValues(from.data() + run.unknown, run.count) *
            ConstValues(factors.data() + run.unknown, run.count);
      return;
    }
    system_.residual(t, z_.get(), z_dot_.get(), f);
    add_held_loads(system_, start_.held, f);
    if (is_midpoint_) constrain_end(f);
    petsc::check(VecPointwiseMult(f, f, scaling_.rows.get()));
  }

  /// Of the unknowns on this rank, at z_ and z_dot_. The rows of the border are complete.
  void find_residual_on_rank(double t) {
    partition_.ranks().attempt([&] {
      system_.residual(t, z_.get(), z_dot_.get(), r_.get());
      if (partition_.is_first()) add_held_loads(system_, start_.held, r_.get());
    });
    sum_border(r_.get());
  }

  void tangent(double t, Vec x, Vec x_dot, double shift, Mat matrix) {
    unscale(x, z_.get());
    unscale(x_dot, z_dot_.get());
    partition_.ranks().attempt(
        [&] { system_.tangents(t, z_.get(), z_dot_.get(), shift, jacobian_.get(), nullptr); });
    if (is_midpoint_) constrain_end(jacobian_.get());
    apply_scaling(scaling_, jacobian_.get());
    if (partition_.is_distributed()) {  // a new state of the shell
      petsc::check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
      petsc::check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    }
    KSP linear = nullptr;
    petsc::check(SNESGetKSP(snes_, &linear));
    petsc::check(KSPSetOperators(linear, matrix, matrix));
    factor_failure_ = set_up(linear);  // without factors SNES fails, and TS cuts the step
    ++factorizations_;
    is_new_tangent_ = true;
  }

  // ---- the midpoint rule -----------------------------------------------------------------------

  /// Half the residual of the constraint rows at the end of the step, where z = z_m + z_dot dt/2:
  /// its derivative by z_m is K there.
  void constrain_end(Vec f) {
    find_end();
    system_.residual(end_time_, z_end_.get(), no_rates_.get(), r_.get());
    const petsc::ReadView at_end(r_.get());
    const petsc::WriteView rows(f);
    for (const PetscInt i : constraints_) rows[i] = 0.5 * at_end[i];
  }

  void constrain_end(Mat matrix) {
    find_end();
    system_.tangents(end_time_, z_end_.get(), no_rates_.get(), 0.0, jacobian_end_.get(), nullptr);
    const std::vector<system::RowRole>& roles = system_.rows();
    MatrixEntries at_end(jacobian_end_.get());
    MatrixEntries target(matrix);
    const PetscScalar* values = at_end.values();
    target.for_each([&, n = std::size_t{0}](PetscInt i, PetscInt, PetscScalar& value) mutable {
      if (roles[static_cast<std::size_t>(i)] == system::RowRole::constraint) value = values[n];
      ++n;
    });
  }

  /// Finds the end of the step from its middle in z_, z_dot_ and t_.
  void find_end() {
    PetscReal dt = 0.0;
    petsc::check(TSGetTimeStep(ts_.get(), &dt));
    end_time_ = t_ + 0.5 * dt;
    petsc::check(VecWAXPY(z_end_.get(), 0.5 * dt, z_dot_.get(), z_.get()));
  }

  /// Starts the midpoint rule: makes the velocities admissible, and discards the errors of earlier
  /// steps.
  void begin_midpoint() {
    if (!is_midpoint_) return;
    velocities_.emplace(system_, options_.step);
    if (!velocities_->is_restricted()) {
      velocities_.reset();
      return;
    }
    const Eigen::Index n = system_.size();
    kick_ = Eigen::VectorXd::Zero(n);
    used_kick_ = kick_;
    missed_.resize(0);
    kick_step_ = options_.step;
    double t = 0.0;
    petsc::check(TSGetTime(ts_.get(), &t));
    const Eigen::VectorXd z = read_state(x_.get());
    put(z, z_end_.get());
    const Jumps jumps = velocities_->correct(t, z_end_.get(), kick_);
    admissible_ = z + velocities_only(jumps.col(0));
    write_state(admissible_);
  }

  Eigen::VectorXd velocities_only(const Eigen::VectorXd& jumps) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(jumps.size());
    for (Eigen::Index i = 0; i < jumps.size(); ++i)
      if (system_.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::velocity)
        result(i) = jumps(i);
    return result;
  }

  /// Changes the state without notice to TS. With notice TS would take the changed solution for a
  /// new start, and would not use the error of the steps for the length of the next one.
  void change_state(const Eigen::VectorXd& z) {
    const petsc::ReadView factors(scaling_.columns.get());
    const PetscScalar* values = nullptr;
    petsc::check(VecGetArrayRead(x_.get(), &values));
    Eigen::Map<Eigen::VectorXd>(const_cast<PetscScalar*>(values), z.size()) =
        z.cwiseQuotient(Eigen::Map<const Eigen::VectorXd>(factors.data(), z.size()));
    petsc::check(VecRestoreArrayRead(x_.get(), &values));
  }

  /// Half of the expected error of the next step is subtracted from the velocities before it. The
  /// error of a step is proportional to the square of its length.
  void kick(double dt) {
    if (!velocities_) return;
    const double growth = dt / kick_step_;
    used_kick_ = growth * growth * kick_;
    missed_ *= growth * growth;
    change_state(admissible_ + velocities_only(used_kick_));
  }

  /// Makes the velocities at the end of a step admissible. Afterwards z_ and z_dot_ contain the
  /// middle of the step between admissible velocities, with the mean of the reactions over the
  /// step.
  void finish_midpoint(double t, double dt) {
    if (!velocities_) return;
    const Eigen::VectorXd before = admissible_;
    const Eigen::VectorXd z = read_state(x_.get());
    put(z, z_end_.get());
    // The error of the step is d = e - k, with the jump e at its end and the correction k before
    // it; the next kick is -d/2 or, if the step before had d_last, -(2/3 d - d_last/6).
    const bool is_first = missed_.size() == 0;
    const Eigen::VectorXd carried =
        is_first ? Eigen::VectorXd(0.5 * used_kick_)
                 : Eigen::VectorXd(2.0 / 3.0 * used_kick_ + 1.0 / 6.0 * missed_);
    const Jumps jumps = velocities_->correct(t, z_end_.get(), velocities_only(carried));
    admissible_ = z + velocities_only(jumps.col(0));
    {
      const petsc::WriteView middle(z_.get());
      const petsc::WriteView rates(z_dot_.get());
      for (Eigen::Index i = 0; i < z.size(); ++i) {
        const auto k = static_cast<PetscInt>(i);
        if (system_.unknowns()[static_cast<std::size_t>(i)].role == system::UnknownRole::velocity) {
          middle[k] = 0.5 * (before(i) + admissible_(i));
          rates[k] = (admissible_(i) - before(i)) / dt;
        } else if (velocities_->is_reaction(i)) {
          middle[k] += (used_kick_(i) + jumps(i, 0)) / dt;
          admissible_(i) = middle[k];  // reactions have no value at a step's end; a guess for TS
          rates[k] = 0.0;
        }
      }
    }
    change_state(admissible_);
    missed_ = jumps.col(0) - used_kick_;
    kick_ = -(is_first ? 0.5 : 2.0 / 3.0) * jumps.col(0) - jumps.col(1);
    kick_step_ = dt;
  }

  static void put(const Eigen::VectorXd& values, Vec target) {
    const petsc::WriteView view(target);
    Eigen::Map<Eigen::VectorXd>(view.data(), values.size()) = values;
  }

  /// Passes the first row of the time series to the observer; false where the observer ends the run
  /// there. Where the rates are not known, rates and internal loads are those of a backward Euler
  /// step that is too short to change the positions.
  bool sample_start() {
    const double dt = start_fraction * options_.step;
    Eigen::VectorXd z = start_.z;
    Eigen::VectorXd z_dot = start_.z_dot;
    if (z_dot.size() == 0) {
      z_dot = Eigen::VectorXd::Zero(z.size());
      DirectSolver solver("transient_start_", [this, dt](Mat matrix) {
        return scale_by_role(system_, matrix, 1.0 / dt);
      });
      for (int i = 0; i < start_iterations; ++i) {
        put(z, z_.get());
        put(z_dot, z_dot_.get());
        z -= partition_.is_distributed() ? distributed_change(dt) : change_at_start(solver, dt);
        z_dot = (z - start_.z) / dt;
      }
    }
    put(z, z_.get());  // it has room for the unknowns of all ranks
    put(z_dot, z_dot_.get());
    begin_angles(z_dot);
    return show({start_.time, z_.get(), z_dot_.get(), 0, true});
  }

  /// Newton's step of a backward Euler step.
  Eigen::VectorXd change_at_start(DirectSolver& solver, double dt) {
    system_.residual(start_.time + dt, z_.get(), z_dot_.get(), r_.get());
    add_held_loads(system_, start_.held, r_.get());
    system_.tangents(start_.time + dt, z_.get(), z_dot_.get(), 1.0 / dt, jacobian_.get(), nullptr);
    solver.factor(jacobian_.get());
    Eigen::MatrixXd change = values_of(r_.get());
    solver.solve(change);
    return change;
  }

  /// The same of a distributed mesh, with the unknowns of all ranks.
  Eigen::VectorXd distributed_change(double dt) {
    find_residual_on_rank(start_.time + dt);
    partition_.ranks().attempt([&] {
      system_.tangents(start_.time + dt, z_.get(), z_dot_.get(), 1.0 / dt, jacobian_.get(),
                       nullptr);
    });
    const Equilibration scaling = scaling_of(jacobian_.get(), 1.0 / dt);
    apply_scaling(scaling, jacobian_.get());
    if (!factors_->factor(jacobian_.get()))
      throw SingularError("transient: the tangent at the start is singular");
    petsc::check(VecPointwiseMult(r_.get(), r_.get(), scaling.rows.get()));
    {
      const petsc::WriteView right(r_.get());
      if (!partition_.is_first())
        for (const PetscInt unknown : border_) right[unknown] = 0.0;
      factors_->solve(right.data());
    }
    petsc::check(VecPointwiseMult(r_.get(), r_.get(), scaling.columns.get()));
    return values_of(r_.get());
  }

  /// Passes a sample to the observers of all ranks, which have the same vectors. @returns false
  /// where one of them ends the run
  bool show(const TransientSample& sample) {
    bool goes_on = false;
    partition_.ranks().attempt([&] { goes_on = observer_.sample(sample); });
    return partition_.ranks().all(goes_on);
  }

  // ---- TS --------------------------------------------------------------------------------------

  void make_integrator(double time) {
    petsc::check(TSCreate(partition_.ranks().comm, ts_.fill()));
    TS ts = ts_.get();
    petsc::check(TSSetOptionsPrefix(ts, "transient_"));
    petsc::check(TSSetApplicationContext(ts, this));
    petsc::check(TSSetProblemType(ts, TS_NONLINEAR));
    petsc::check(TSSetEquationType(ts, TS_EQ_IMPLICIT));
    petsc::check(TSSetIFunction(ts, nullptr, form_function, this));
    if (partition_.is_distributed()) make_shell();
    const Mat matrix = partition_.is_distributed() ? shell_.get() : jacobian_.get();
    petsc::check(TSSetIJacobian(ts, matrix, matrix, form_jacobian, this));
    petsc::check(TSSetType(ts, options_.method == TransientMethod::bdf2 ? TSBDF : TSTHETA));
    if (options_.method == TransientMethod::bdf2) petsc::check(TSBDFSetOrder(ts, 2));
    if (options_.method == TransientMethod::midpoint) petsc::check(TSThetaSetTheta(ts, 0.5));
    TSAdapt adapt = nullptr;
    petsc::check(TSGetAdapt(ts, &adapt));
    petsc::check(TSAdaptSetType(adapt, TSADAPTNONE));
    if (options_.step_tolerance > 0.0) make_adaptive(adapt);
    petsc::check(TSSetTime(ts, time));
    petsc::check(TSSetTimeStep(ts, options_.step));
    petsc::check(TSSetMaxTime(ts, 0.5 * PETSC_MAX_REAL));
    petsc::check(TSSetMaxSteps(ts, PETSC_MAX_INT - 1));
    petsc::check(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_STEPOVER));
    petsc::check(TSSetMaxSNESFailures(ts, -1));  // TS itself counts those of a step
    petsc::check(TSSetErrorIfStepFails(ts, PETSC_FALSE));
    petsc::check(TSSetPreStep(ts, before_step));
    petsc::check(TSSetPreStage(ts, before_stage));
    petsc::check(TSSetPostStep(ts, after_step));
    petsc::check(TSGetSNES(ts, &snes_));
    petsc::check(SNESSetTolerances(snes_, 0.0, 0.0, 0.0, most_newton_steps, PETSC_MAX_INT));
    petsc::check(SNESSetConvergenceTest(snes_, test_convergence, this, nullptr));
    SNESLineSearch search = nullptr;
    petsc::check(SNESGetLineSearch(snes_, &search));
    petsc::check(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
    petsc::check(SNESSetLagJacobianPersists(snes_, PETSC_TRUE));
    KSP linear = nullptr;
    PC preconditioner = nullptr;
    petsc::check(SNESGetKSP(snes_, &linear));
    petsc::check(KSPSetType(linear, KSPPREONLY));
    petsc::check(KSPGetPC(linear, &preconditioner));
    if (partition_.is_distributed()) {
      petsc::check(PCSetType(preconditioner, PCSHELL));
      petsc::check(PCShellSetName(preconditioner, "pieces of the mesh with a border"));
      petsc::check(PCShellSetContext(preconditioner, this));
      petsc::check(PCShellSetSetUp(preconditioner, factor_parts));
      petsc::check(PCShellSetApply(preconditioner, solve_parts));
    } else {
      petsc::check(PCSetType(preconditioner, PCLU));
      petsc::check(PCFactorSetMatOrderingType(preconditioner, MATORDERINGNATURAL));
    }
    petsc::take_options(TSSetFromOptions, ts);
    require_sound_type();
    prepare_midpoint();
  }

  // ---- a distributed mesh ----------------------------------------------------------------------

  /// The tangent of all ranks, scaled: each has its part in `jacobian_`.
  void make_shell() {
    factors_.emplace(partition_, jacobian_.get());
    const auto own = static_cast<PetscInt>(partition_.counted().size());
    petsc::check(MatCreateShell(partition_.ranks().comm, own, own, PETSC_DETERMINE, PETSC_DETERMINE,
                                this, shell_.fill()));
    petsc::check(MatShellSetOperation(shell_.get(), MATOP_MULT,
                                      reinterpret_cast<void (*)()>(multiply_parts)));
  }

  static PetscErrorCode multiply_parts(Mat matrix, Vec x, Vec y) noexcept {
    void* context = nullptr;
    if (const PetscErrorCode code = MatShellGetContext(matrix, &context)) return code;
    Integration& self = *static_cast<Integration*>(context);
    return self.guarded([&] {
      Eigen::MatrixXd values(1, self.partition_.size());
      {
        const petsc::ReadView view(x);
        self.partition_.spread(view.data(), values);
      }
      const petsc::Handle<Vec> in = self.system_.make_state();
      const petsc::Handle<Vec> out = self.system_.make_state();
      petsc::check(VecSet(in.get(), 0.0));
      {
        const petsc::WriteView view(in.get());
        Eigen::Map<Eigen::RowVectorXd>(view.data(), self.system_.size())(self.partition_.kept()) =
            values;
      }
      petsc::check(MatMult(self.jacobian_.get(), in.get(), out.get()));
      {
        const petsc::ReadView view(out.get());
        values = self.partition_.local(
            Eigen::Map<const Eigen::RowVectorXd>(view.data(), self.system_.size()));
      }
      self.partition_.sum_border(values);
      const petsc::WriteView view(y);
      self.partition_.collect(values, view.data());
    });
  }

  static PetscErrorCode factor_parts(PC preconditioner) noexcept {
    void* context = nullptr;
    if (const PetscErrorCode code = PCShellGetContext(preconditioner, &context)) return code;
    Integration& self = *static_cast<Integration*>(context);
    return self.guarded([&] {
      const bool is_regular = self.factors_->factor(self.jacobian_.get());
      petsc::check(
          PCSetFailedReason(preconditioner, is_regular ? PC_NOERROR : PC_FACTOR_NUMERIC_ZEROPIVOT));
    });
  }

  static PetscErrorCode solve_parts(PC preconditioner, Vec x, Vec y) noexcept {
    void* context = nullptr;
    if (const PetscErrorCode code = PCShellGetContext(preconditioner, &context)) return code;
    Integration& self = *static_cast<Integration*>(context);
    return self.guarded([&] {
      const petsc::WriteView values(self.r_.get());
      for (const PetscInt unknown : self.border_) values[unknown] = 0.0;
      {
        const petsc::ReadView from(x);
        for (const MeshPartition::Run& run : self.runs_)
          Values(values.data() + run.unknown, run.count) =
              ConstValues(from.data() + run.counted, run.count);
      }
      self.factors_->solve(values.data());
      const petsc::WriteView to(y);
      for (const MeshPartition::Run& run : self.runs_)
        Values(to.data() + run.counted, run.count) =
            ConstValues(values.data() + run.unknown, run.count);
    });
  }

  /// The midpoint rule is TS's theta method where its stage is the middle of the step.
  void prepare_midpoint() {
    PetscBool is_theta = PETSC_FALSE;
    PetscBool ends = PETSC_FALSE;
    PetscReal theta = 0.0;
    petsc::check(
        PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ts_.get()), TSTHETA, &is_theta));
    if (is_theta == PETSC_FALSE) return;
    petsc::check(TSThetaGetTheta(ts_.get(), &theta));
    petsc::check(TSThetaGetEndpoint(ts_.get(), &ends));
    is_midpoint_ = theta == 0.5 && ends == PETSC_FALSE;
    if (!is_midpoint_) return;
    z_end_ = system_.make_state();
    no_rates_ = system_.make_state();
    petsc::check(VecSet(no_rates_.get(), 0.0));
    jacobian_end_ = system_.make_jacobian();
    for (std::size_t i = 0; i < system_.rows().size(); ++i)
      if (system_.rows()[i] == system::RowRole::constraint)
        constraints_.push_back(static_cast<PetscInt>(i));
  }

  /// Chooses steps by the error of the positions and of first-order states. Internal loads and,
  /// with rigid strains, velocities are not smooth where the step changes, and would cut it
  /// needlessly.
  void make_adaptive(TSAdapt adapt) {
    petsc::check(TSAdaptSetType(adapt, TSADAPTBASIC));
    petsc::check(TSAdaptSetClip(adapt, least_growth, largest_growth));
    const std::vector<system::Unknown>& unknowns = system_.unknowns();
    const auto count = std::ranges::count_if(unknowns, &system::Unknown::is_coordinate);
    // TS takes the mean square over all unknowns, most of which are left out here.
    const double tolerance =
        options_.step_tolerance *
        std::sqrt(static_cast<double>(count) / static_cast<double>(unknowns.size()));
    petsc::check(VecDuplicate(x_.get(), tolerances_.fill()));
    {
      const petsc::WriteView view(tolerances_.get());
      const std::vector<PetscInt>& counted = partition_.counted();
      for (std::size_t i = 0; i < counted.size(); ++i) {
        const PetscInt unknown = partition_.kept()[static_cast<std::size_t>(counted[i])];
        view[static_cast<PetscInt>(i)] =
            unknowns[static_cast<std::size_t>(unknown)].is_coordinate() ? tolerance : left_out;
      }
    }
    petsc::check(TSSetTolerances(ts_.get(), tolerance, tolerances_.get(), tolerance, nullptr));
  }

  /// Some types of TS cannot solve for z where M is singular, or change r; they would fail later.
  void require_sound_type() const {
    TSType type = nullptr;
    petsc::check(TSGetType(ts_.get(), &type));
    const std::string name = type;
    if (name == TSBDF) require_stable_order();
    if (std::find(sound_types.begin(), sound_types.end(), name) != sound_types.end()) return;
    std::string words;
    for (const char* sound : sound_types) words += std::string(words.empty() ? "" : ", ") + sound;
    throw InputError("-transient_ts_type " + name +
                     ": not suitable for a system with constraints; suitable types: " + words);
  }

  void require_stable_order() const {
    PetscInt order = 0;
    petsc::check(TSBDFGetOrder(ts_.get(), &order));
    if (order > most_stable_order)
      throw InputError("-transient_ts_bdf_order " + std::to_string(order) +
                       ": from order 3 on BDF is unstable with rigid strains; hint: order 2");
  }

  double grid(long step) const { return origin_ + static_cast<double>(step) * options_.step; }

  static Integration& of(TS ts) {
    void* context = nullptr;
    TSGetApplicationContext(ts, &context);
    return *static_cast<Integration*>(context);
  }

  template <class Work>
  PetscErrorCode guarded(const Work& work) noexcept {
    try {
      work();
    } catch (...) {
      error_ = std::current_exception();
      return PETSC_ERR_USER;
    }
    return 0;
  }

  /// Divides the time to the next instant of the grid into equal steps no longer than the limit.
  static PetscErrorCode before_step(TS ts) noexcept {
    Integration& self = of(ts);
    return self.guarded([&] {
      double t = 0.0;
      petsc::check(TSGetTime(ts, &t));
      petsc::check(VecCopy(self.x_.get(), self.before_.get()));
      self.time_before_ = t;
      self.note_angles();
      self.step_before_ = self.step_;
      const double rest = self.target() - t;
      const double parts = std::ceil(rest / self.limit_ * (1.0 - round_off));
      self.asked_ = rest / std::max(parts, 1.0);
      self.kick(self.asked_);
      petsc::check(TSSetTimeStep(ts, self.asked_));
    });
  }

  /// Time at which the step is to end: the next instant of the grid, or the stop of the run.
  double target() const {
    const double next = grid(step_ + 1);
    return options_.stop_at ? std::min(next, *options_.stop_at) : next;
  }

  static PetscErrorCode before_stage(TS ts, PetscReal) noexcept {
    Integration& self = of(ts);
    return self.guarded([&] {
      if (self.steps_since_start_ < starting_steps) self.renew_tangent();
    });
  }

  /// The longest step after a start.
  double start_limit() const { return options_.step * (is_bdf() ? first_step : 1.0); }

  bool is_bdf() const {
    PetscBool is_one = PETSC_FALSE;
    petsc::check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ts_.get()), TSBDF, &is_one));
    return is_one != PETSC_FALSE;
  }

  void renew_tangent() { petsc::check(SNESSetLagJacobian(snes_, -2)); }

  static PetscErrorCode after_step(TS ts) noexcept {
    Integration& self = of(ts);
    return self.guarded([&] { self.finish_step(); });
  }

  void finish_step() {
    TS ts = ts_.get();
    double t = 0.0;
    double next = 0.0;
    double before = 0.0;
    petsc::check(TSGetTime(ts, &t));
    petsc::check(TSGetPrevTime(ts, &before));
    petsc::check(TSGetTimeStep(ts, &next));
    const double taken = t - before;
    const bool was_cut = taken < asked_ * (1.0 - round_off);
    if (was_cut) ++cuts_;
    limit_ = was_cut ? taken : std::min(largest_growth * limit_, options_.step);
    if (options_.step_tolerance > 0.0) limit_ = std::min(limit_, next);
    ++steps_;
    ++steps_since_start_;
    const double close = round_off * options_.step;
    const bool on_grid = std::abs(t - grid(step_ + 1)) <= close;
    const bool is_stop = options_.stop_at && std::abs(t - *options_.stop_at) <= close;
    if (on_grid) {
      ++step_;
      petsc::check(TSSetTime(ts, grid(step_)));
    }
    finish_midpoint(t, taken);
    note_rates(taken);
    const Vec z = gathered(z_.get(), whole_z_);
    try {
      whole_.require_admissible(t_, z);
    } catch (const DomainError& error) {
      throw DomainError("transient at t = " + general(t_, 6) + " s: " + error.what());
    }
    const bool goes_on = show({t_, z, gathered(z_dot_.get(), whole_z_dot_), step_, on_grid});
    if (on_grid && step_ < last_step_ && options_.checkpoint_steps > 0 &&
        step_ % options_.checkpoint_steps == 0)
      make_checkpoint();
    if (step_ >= last_step_)
      reason_ = TransientEnd::complete;
    else if (is_stop)
      reason_ = TransientEnd::stopped;
    else if (!goes_on)
      reason_ = TransientEnd::observer;
    else
      return;
    petsc::check(TSSetConvergedReason(ts, TS_CONVERGED_USER));
  }

  void make_checkpoint() {
    petsc::check(TSRestartStep(ts_.get()));
    steps_since_start_ = 0;
    limit_ = start_limit();
    const TransientStart point = state();
    begin_angles(point.z_dot);
    partition_.ranks().attempt([&] { observer_.checkpoint(point); });
    begin_midpoint();
  }

  static PetscErrorCode form_function(TS, PetscReal t, Vec x, Vec x_dot, Vec f,
                                      void* pointer) noexcept {
    Integration& self = *static_cast<Integration*>(pointer);
    return self.in_domain([&] { return SNESSetFunctionDomainError(self.snes_); },
                          [&] { self.residual(t, x, x_dot, f); });
  }

  static PetscErrorCode form_jacobian(TS, PetscReal t, Vec x, Vec x_dot, PetscReal shift, Mat,
                                      Mat matrix, void* pointer) noexcept {
    Integration& self = *static_cast<Integration*>(pointer);
    return self.in_domain([&] { return self.refuse_tangent(); },
                          [&] { self.tangent(t, x, x_dot, shift, matrix); });
  }

  /// PETSc's own flag ends no solve in its optimized builds, and is never cleared in others: a
  /// solve with a matrix that is half written ends by test_convergence().
  PetscErrorCode refuse_tangent() {
    is_tangent_refused_ = true;
    return SNESSetLagJacobian(snes_, -2);  // a new one in the next solve
  }

  /// Rotations out of range make the step shorter, other errors end the run.
  template <class Refuse, class Work>
  PetscErrorCode in_domain(const Refuse& refuse, const Work& work) noexcept {
    try {
      work();
      error_ = nullptr;  // an earlier attempt out of range is no cause of a later failure
    } catch (const DomainError&) {
      error_ = std::current_exception();
      return refuse();
    } catch (...) {
      error_ = std::current_exception();
      return PETSC_ERR_USER;
    }
    return 0;
  }

  /// The remaining error after a correction d that reduces the residual by the factor rho is about
  /// rho / (1 - rho) |d|.
  static PetscErrorCode test_convergence(SNES snes, PetscInt iteration, PetscReal size,
                                         PetscReal change, PetscReal residual,
                                         SNESConvergedReason* reason, void* pointer) noexcept {
    Integration& self = *static_cast<Integration*>(pointer);
    *reason = SNES_CONVERGED_ITERATING;
    const double before = self.last_residual_;
    self.last_residual_ = residual;
    if (!std::isfinite(residual)) {
      *reason = SNES_DIVERGED_FNORM_NAN;
      return 0;
    }
    if (residual == 0.0) {
      *reason = SNES_CONVERGED_FNORM_ABS;
      return 0;
    }
    if (iteration == 0) {
      self.is_tangent_refused_ = false;
      return 0;
    }
    if (self.is_tangent_refused_) {
      *reason = SNES_DIVERGED_JACOBIAN_DOMAIN;
      return 0;
    }
    ++self.newton_steps_;
    const double contraction = residual / before;
    const bool is_solved = contraction < 1.0 && contraction / (1.0 - contraction) * change <=
                                                    self.options_.tolerance * size;
    // The tangent is new: the remaining residual is round-off.
    const bool is_stagnant =
        self.is_new_tangent_ && contraction > slow_contraction && change <= stagnation * size;
    if (is_solved || is_stagnant) {
      *reason = self.goes_on() ? SNES_CONVERGED_SNORM_RELATIVE : SNES_DIVERGED_DTOL;
      return 0;
    }
    self.is_new_tangent_ = false;
    if (contraction <= slow_contraction) return 0;
    return SNESSetLagJacobian(snes, -2);
  }

  // ---- failure ---------------------------------------------------------------------------------

  [[noreturn]] void fail(const std::string& reason) {
    std::ostringstream text;
    double t = 0.0;
    petsc::check(TSGetTime(ts_.get(), &t));
    text << "transient: no step from t = " << t << " s (" << reason << ")";
    Vec change = nullptr;
    petsc::check(SNESGetSolutionUpdate(snes_, &change));
    if (change != nullptr) {
      Eigen::MatrixXd values(1, partition_.size());
      {
        const petsc::ReadView view(change);
        partition_.spread(view.data(), values);
      }
      Eigen::Index worst = 0;
      partition_.whole(values).row(0).cwiseAbs().maxCoeff(&worst);
      text << "; the unknown that changes most: "
           << system_.unknowns()[static_cast<std::size_t>(worst)].name();
    }
    if (factor_failure_.reason != PC_NOERROR) text << "; " << factor_failure_.words;
    if (error_) {
      try {
        std::rethrow_exception(error_);
      } catch (const std::exception& error) {
        text << "; " << error.what();
      }
    }
    text << "; hint: a smaller transient.step; -transient_snes_monitor shows the corrections";
    throw ConvergenceError(text.str());
  }

  const system::PeriodicSystem& whole_;
  MeshPartition partition_;
  const system::PeriodicSystem& system_;  ///< part of this rank
  const TransientOptions& options_;
  TransientObserver& observer_;
  const TransientStart& start_;
  double origin_;
  long step_;           ///< of the grid, completed
  long last_step_;      ///< last one of the grid
  double limit_ = 0.0;  ///< upper limit of the step [s], reduced after a cut
  double asked_ = 0.0;
  petsc::Handle<Vec> z_;      ///< of the last residual
  petsc::Handle<Vec> z_dot_;  ///< of the last residual
  petsc::Handle<Vec> r_;
  petsc::Handle<Mat> jacobian_;
  std::vector<MeshPartition::Run> runs_;     ///< of a distributed mesh
  std::vector<PetscInt> border_;             ///< the same, unknowns
  petsc::Handle<Mat> shell_;                 ///< the same
  std::optional<PartitionFactors> factors_;  ///< the same
  petsc::Handle<Vec> whole_z_;               ///< the same, for observers
  petsc::Handle<Vec> whole_z_dot_;
  Equilibration scaling_;
  petsc::Handle<Vec> x_;  ///< z, scaled
  petsc::Handle<Vec> tolerances_;
  petsc::Handle<TS> ts_;
  SNES snes_ = nullptr;
  bool is_tangent_refused_ = false;  ///< in the present solve
  double t_ = 0.0;                   ///< of the last residual
  bool is_midpoint_ = false;
  std::vector<PetscInt> constraints_;
  petsc::Handle<Vec> z_end_;
  double end_time_ = 0.0;
  petsc::Handle<Vec> no_rates_;
  petsc::Handle<Mat> jacobian_end_;
  std::optional<AdmissibleVelocities> velocities_;  ///< empty where all are admissible
  Eigen::VectorXd admissible_;                      ///< z at the end of the last step
  Eigen::VectorXd kick_;       ///< jump before the next step, velocities and impulses
  double kick_step_ = 0.0;     ///< length of the step that kick_ is for [s]
  Eigen::VectorXd used_kick_;  ///< jump before the last step
  Eigen::VectorXd missed_;     ///< error of the last step; empty: none since the start
  double last_residual_ = 0.0;
  int steps_since_start_ = 0;
  bool is_new_tangent_ = false;  ///< new since the last correction
  TransientEnd reason_ = TransientEnd::complete;
  petsc::Handle<Vec> before_;  ///< x before the last step
  double time_before_ = 0.0;
  std::vector<Angle> angles_;
  bool has_rates_ = false;  ///< the rates of angles_ are known
  long step_before_ = 0;
  long steps_ = 0;
  long newton_steps_ = 0;
  long factorizations_ = 0;
  long cuts_ = 0;
  FactorFailure factor_failure_;  ///< of the last tangent
  std::exception_ptr error_;
};

}  // namespace

bool is_distributed(const system::PeriodicSystem& system, const TransientOptions& options,
                    MPI_Comm comm) {
  return MeshPartition(system, {}, false, ranks_for(options, comm)).is_distributed();
}

TransientRun run_transient(const system::PeriodicSystem& system, const TransientStart& start,
                           const TransientOptions& options, TransientObserver& observer,
                           MPI_Comm comm) {
  require_roles(system);
  return Integration(system, start, options, observer, comm).run();
}

TransientStart start_undeformed(const system::PeriodicSystem& system, double t) {
  const petsc::Handle<Vec> z = system.make_state();
  system.reference_state(t, z.get());
  const petsc::ReadView view(z.get());
  TransientStart start;
  start.time = t;
  start.origin = t;
  start.z = Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
  return start;
}

TransientStart start_on(const system::PeriodicSystem& system, const Trim& trim, double t) {
  const petsc::Handle<Vec> z = system.make_state();
  const petsc::Handle<Vec> z_dot = system.make_state();
  trim.solution.evaluate(t, z.get(), z_dot.get());
  const petsc::ReadView view(z.get());
  TransientStart start;
  start.time = t;
  start.origin = t;
  const petsc::ReadView rates(z_dot.get());
  start.z = Eigen::Map<const Eigen::VectorXd>(view.data(), system.size());
  start.z_dot = Eigen::Map<const Eigen::VectorXd>(rates.data(), system.size());
  start.held = trim.held;
  return start;
}

}  // namespace samara::analysis
