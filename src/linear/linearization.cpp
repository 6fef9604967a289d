#include "samara/linear/linearization.hpp"

#include <algorithm>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "samara/analysis/linear_algebra.hpp"
#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/linear/hill.hpp"
#include "samara/linear/multiblade.hpp"

namespace samara::linear {
namespace {

/// Relative; smaller changes with the azimuth are round-off.
constexpr double constant_tolerance = 1e-9;
constexpr double round_off = std::numeric_limits<double>::epsilon();
/// Round-off of the largest entry of A below which eigenvalues of A are not in doubt.
constexpr double least_round_off = 1e-3;
/// Change of an eigenvalue by round-off that is noted, relative to it or to a slow one [1/s].
constexpr double largest_change = 1e-4;
constexpr double slowest = 0.1;
constexpr int samples_of_round_off = 4;

struct EigenvalueChange {
  double relative = 0.0;
  double modulus = 0.0;  ///< [1/s]
};

/// The largest change of an eigenvalue of A where each entry changes by its round-off, up or down.
EigenvalueChange change_by_round_off(const Eigen::MatrixXd& A) {
  const std::vector<std::complex<double>> own = analysis::dense_eigenvalues(A);
  std::mt19937_64 generator(1);
  EigenvalueChange most;
  for (int sample = 0; sample < samples_of_round_off; ++sample) {
    Eigen::MatrixXd changed = A;
    for (double& entry : changed.reshaped())
      entry *= generator() % 2 == 0 ? 1.0 + round_off : 1.0 - round_off;
    const std::vector<std::complex<double>> others = analysis::dense_eigenvalues(changed);
    for (const std::complex<double> one : own) {
      double change = std::numeric_limits<double>::infinity();
      for (const std::complex<double> other : others)
        change = std::min(change, std::abs(other - one));
      change /= std::max(std::abs(one), slowest);
      if (change > most.relative) most = {change, std::abs(one)};
    }
  }
  return most;
}

std::vector<std::string> function_names(int harmonics) {
  std::vector<std::string> names{"mean "};
  for (int k = 1; k <= harmonics; ++k) {
    names.push_back("cos " + std::to_string(k) + " ");
    names.push_back("sin " + std::to_string(k) + " ");
  }
  return names;
}

template <class Named>
std::vector<Named> repeated(const std::vector<Named>& all, int harmonics) {
  std::vector<Named> result;
  for (const std::string& word : function_names(harmonics))
    for (Named named : all) {
      named.name = word + named.name;
      result.push_back(named);
    }
  return result;
}

std::vector<system::Signal> signals_of(const std::vector<ModelState>& states) {
  std::vector<system::Signal> signals;
  for (const ModelState& state : states) {
    system::Signal signal;
    signal.name = state.name;
    signal.unit = "1";
    signal.frame = "of the states";
    signal.description = "state";
    signals.push_back(signal);
  }
  return signals;
}

NamedForm average_of(const NamedForm& form) {
  NamedForm average = form;
  average.name = form.name + "_average";
  average.description = "mean over the azimuth of " + form.name;
  average.series = AzimuthSeries({form.series.mean()});
  average.at_azimuths.clear();
  return average;
}

/// The states of the result are combinations of all states of `form`.
NamedForm reduced_of(const NamedForm& form, const LinearizeOptions& options,
                     analysis::Observer& observer) {
  if (options.order >= form.series.mean().A.rows())
    observer.note("note: " + form.name + " has " + std::to_string(form.series.mean().A.rows()) +
                  " states and is not reduced to " + std::to_string(options.order));
  const ReducedForm reduced = reduce(form.series.mean(), options.order, options.reduction);
  NamedForm small = form;
  small.name = form.name + "_reduced";
  small.description = form.name +
                      (options.reduction == ReductionMethod::modal ? ", the slowest modes"
                                                                   : ", balanced and truncated") +
                      "; the first " + std::to_string(reduced.kept) +
                      " states are neutral or unstable";
  small.states.clear();
  for (Eigen::Index i = 0; i < reduced.form.A.rows(); ++i)
    small.states.push_back({"reduced " + std::to_string(i + 1), "1", 1.0});
  small.series = AzimuthSeries({reduced.form});
  small.hankel = reduced.hankel;
  small.error_bound = reduced.error_bound;
  return small;
}

/// Forms over the azimuth, each of which is computed once.
class Remembered {
 public:
  explicit Remembered(std::function<StateSpace(double)> compute) : compute_(std::move(compute)) {}

  const StateSpace& at(double psi) {
    const auto found = known_.find(psi);
    return found != known_.end() ? found->second : known_.emplace(psi, compute_(psi)).first->second;
  }
  std::size_t size() const { return known_.size(); }

 private:
  std::function<StateSpace(double)> compute_;
  std::map<double, StateSpace> known_;
};

/// Makes the requested forms from those of one linear model.
class Linearizer {
 public:
  Linearizer(const LinearModel& model, double start_azimuth, const LinearizeOptions& options,
             analysis::Observer& observer)
      : model_(model),
        start_azimuth_(start_azimuth),
        options_(options),
        observer_(observer),
        has_period_(model.system().period() > 0.0),
        speed_(has_period_ ? 2.0 * std::numbers::pi / model.system().period() : 0.0),
        resolution_(has_period_ ? options.series : SeriesResolution{1, false, 0, false}),
        forms_([this](double psi) { return compute(psi); }),
        periodic_(over_azimuth("state_space", "x_dot = A x + B u, y = C x + D u over the azimuth",
                               model.states(), column_signals(model),
                               model.input_output().outputs(),
                               [this](double psi) { return forms_.at(psi); })) {
    // All other forms have the same azimuths.
    resolution_.azimuths = static_cast<int>(periodic_.series.azimuths().size());
    resolution_.automatic_azimuths = false;
  }

  Linearizer(const Linearizer&) = delete;
  Linearizer& operator=(const Linearizer&) = delete;

  Linearization run() {
    result_.rotor_speed = speed_;
    result_.series_azimuths = resolution_.azimuths;
    if (const double residual = periodic_.series.residual();
        has_period_ && options_.series.automatic_azimuths && residual > resolution_.tolerance) {
      const bool is_most = 2 * resolution_.azimuths > AzimuthSeries::most_azimuths;
      observer_.note("note: the residual of the series, " + general(residual, 2) +
                     ", is above linearize.auto_tolerance with " +
                     std::to_string(resolution_.azimuths) + " azimuths" +
                     (!options_.series.automatic_harmonics ? "; hint: linearize.harmonics: auto"
                      : is_most                            ? ", the most that `auto` takes"
                                : ", which more azimuths do not reduce"));
    }
    note_round_off();
    result_.azimuths = azimuths();
    result_.is_constant =
        std::max(periodic_.series.variation(), periodic_.series.residual()) < constant_tolerance;
    add_operation();
    if (options_.multiblade) add_multiblade();
    if (options_.average && !options_.multiblade) add_average();
    if (options_.hill) add_hill();
    if (options_.lyapunov_floquet) add_lyapunov_floquet();
    if (options_.order > 0) add_reduced();
    if (options_.state_space) result_.forms.insert(result_.forms.begin(), std::move(periodic_));
    return std::move(result_);
  }

 private:
  double time_of(double psi) const { return has_period_ ? (psi - start_azimuth_) / speed_ : 0.0; }

  StateSpace compute(double psi) const {
    const auto done = static_cast<long>(forms_.size()) + 1;
    observer_.progress(stage_, done - known_, std::max(done, expected_) - known_);
    return model_.state_space(time_of(psi));
  }

  /// So many forms will be computed, at most.
  void begin(const std::string& stage, std::size_t count) {
    stage_ = stage;
    known_ = static_cast<long>(forms_.size());
    expected_ = known_ + static_cast<long>(count);
  }
  /// Of a series; a series of half as many azimuths is known, if any.
  void begin_series(int azimuths) {
    const int own = forms_.size() > 0 ? azimuths / 2 : azimuths;
    begin("linearize with " + std::to_string(azimuths) + " azimuths",
          static_cast<std::size_t>(own + AzimuthSeries::comparisons));
  }

  /// Notes where round-off of A changes an eigenvalue.
  void note_round_off() const {
    const Eigen::MatrixXd& A = periodic_.series.samples().front().A;
    const double largest = A.cwiseAbs().maxCoeff();
    if (round_off * largest < least_round_off) return;
    const EigenvalueChange most = change_by_round_off(A);
    if (most.relative > largest_change)
      observer_.note("note: round-off of A, whose largest entry is " + general(largest, 2) +
                     ", changes its eigenvalues by up to " + general(100.0 * most.relative, 2) +
                     " % (that of modulus " + general(most.modulus, 3) +
                     " 1/s); hint: samara modes and samara floquet do not use A; a motion has "
                     "little inertia for its stiffness or damping (hub.inertia, inertia of "
                     "sections)");
  }

  bool has_own_azimuths() const { return has_period_ && !options_.at.empty(); }

  /// Azimuths at which matrices are given beside the series.
  std::vector<double> azimuths() const {
    if (has_own_azimuths()) return options_.at;
    return has_period_ ? periodic_.series.azimuths() : std::vector<double>{start_azimuth_};
  }

  NamedForm over_azimuth(const std::string& name, const std::string& description,
                         const std::vector<ModelState>& states,
                         const std::vector<system::Signal>& inputs,
                         const std::vector<system::Signal>& outputs,
                         const std::function<StateSpace(double)>& form_at) {
    NamedForm form{name,
                   description,
                   states,
                   inputs,
                   outputs,
                   AzimuthSeries::resolve(form_at, resolution_,
                                          [this](int azimuths) { begin_series(azimuths); })};
    if (has_own_azimuths()) {
      begin("linearize at linearize.at_deg", options_.at.size());
      for (const double psi : options_.at) form.at_azimuths.push_back(form_at(psi));
    } else {
      form.at_azimuths = form.series.samples();
    }
    return form;
  }

  void add_operation() {
    result_.outputs.resize(static_cast<Eigen::Index>(result_.azimuths.size()),
                           static_cast<Eigen::Index>(periodic_.outputs.size()));
    for (std::size_t i = 0; i < result_.azimuths.size(); ++i) {
      const double t = time_of(result_.azimuths[i]);
      result_.outputs.row(static_cast<Eigen::Index>(i)) = model_.operating_outputs(t).transpose();
      if (options_.descriptor) result_.descriptors.push_back(model_.descriptor(t));
    }
  }

  void add_multiblade() {
    const Multiblade multiblade(model_);
    NamedForm turned = over_azimuth(
        "multiblade", "in multiblade coordinates over the azimuth", multiblade.states(),
        multiblade.inputs(), multiblade.outputs(), [&](double psi) {
          return multiblade.transform(has_period_ ? psi : start_azimuth_, forms_.at(psi));
        });
    if (options_.average) result_.forms.push_back(average_of(turned));
    result_.forms.push_back(std::move(turned));
  }

  void add_average() {
    if (has_period_ && !result_.is_constant)
      observer_.note(
          "note: the average of rotating coordinates loses the coupling of the blades to the parts "
          "that do not rotate; hint: linearize.forms with multiblade and average for three and "
          "more blades, with hill or lyapunov_floquet for fewer");
    result_.forms.push_back(average_of(periodic_));
  }

  void add_hill() {
    const int h = options_.hill_harmonics;
    result_.forms.push_back(
        {"hill", "harmonic lifting (Hill): constant", repeated(periodic_.states, h),
         repeated(periodic_.inputs, h), repeated(periodic_.outputs, h),
         AzimuthSeries({hill_form(periodic_.series, speed_, h)}, periodic_.series.residual())});
  }

  void add_lyapunov_floquet() {
    const LyapunovFloquet floquet(periodic_.series, speed_, resolution_.azimuths,
                                  options_.lyapunov_floquet_states, options_.lyapunov_floquet_steps,
                                  model_.subspace().first_order());
    if (!floquet.remark().empty()) observer_.note("note: " + floquet.remark());
    Remembered maps([&floquet](double psi) { return floquet.transformation(psi); });
    result_.forms.push_back(over_azimuth(
        "lyapunov_floquet", "Lyapunov-Floquet coordinates q: A is constant, B and C periodic",
        floquet.states(), periodic_.inputs, periodic_.outputs,
        [&](double psi) { return floquet.form(psi, maps.at(psi)); }));
    const std::vector<system::Signal> states = signals_of(periodic_.states);
    result_.forms.push_back(
        over_azimuth("lyapunov_floquet_map", "q = B x and x = C q, x the states of state_space",
                     floquet.states(), states, states, [&](double psi) { return maps.at(psi); }));
  }

  void add_reduced() {
    std::vector<NamedForm> reduced;
    if (result_.is_constant) {
      NamedForm constant = average_of(periodic_);
      constant.name = periodic_.name;
      reduced.push_back(reduced_of(constant, options_, observer_));
    } else {
      for (const NamedForm& form : result_.forms)
        if (form.series.harmonics() == 0 && form.series.samples().empty())
          reduced.push_back(reduced_of(form, options_, observer_));
    }
    if (reduced.empty())
      throw InputError(
          "linearize.reduce: there is no constant form; hint: linearize.forms with average or "
          "hill");
    result_.forms.insert(result_.forms.end(), reduced.begin(), reduced.end());
  }

  const LinearModel& model_;
  double start_azimuth_;
  const LinearizeOptions& options_;
  analysis::Observer& observer_;
  bool has_period_;
  double speed_;
  SeriesResolution resolution_;
  std::string stage_;  ///< of the progress
  long known_ = 0;     ///< forms before it
  long expected_ = 0;  ///< forms after it
  Remembered forms_;
  NamedForm periodic_;
  Linearization result_;
};

}  // namespace

Linearization linearize(const system::PeriodicSystem& system,
                        const system::InputOutput& input_output,
                        const analysis::PeriodicSolution& solution, double start_azimuth,
                        const LinearizeOptions& options, analysis::Observer& observer) {
  if (!(system.period() > 0.0) && (options.hill || options.lyapunov_floquet))
    throw InputError(
        "linearize.forms: hill and lyapunov_floquet have no period where the rotor stands still; "
        "hint: state_space is constant there");
  const LinearModel model(system, input_output, solution);
  if (model.states().empty())
    throw InputError("linearize: nothing can move, all strains and joints are rigid");
  return Linearizer(model, start_azimuth, options, observer).run();
}

}  // namespace samara::linear
