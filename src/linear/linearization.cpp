#include "samara/linear/linearization.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/linear/hill.hpp"
#include "samara/linear/lyapunov_floquet.hpp"
#include "samara/linear/multiblade.hpp"

namespace samara::linear {
namespace {

/// Changes with the azimuth below it, relative, are rounding.
constexpr double constant_tolerance = 1e-9;

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

/// Its states are combinations of all.
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

}  // namespace

Linearization linearize(const system::PeriodicSystem& system,
                        const system::InputOutput& input_output,
                        const analysis::PeriodicSolution& solution, double start_azimuth,
                        const LinearizeOptions& options, analysis::Observer& observer) {
  const LinearModel model(system, input_output, solution);
  if (model.states().empty())
    throw InputError("linearize: nothing can move, all strains and joints are rigid");
  Linearization result;
  const bool has_period = system.period() > 0.0;
  result.rotor_speed = has_period ? 2.0 * std::numbers::pi / system.period() : 0.0;
  const int azimuths = has_period ? options.azimuths : 1;
  const int harmonics = std::min(options.harmonics, (azimuths - 1) / 2);
  const auto time_of = [&](double psi) {
    return has_period ? (psi - start_azimuth) / result.rotor_speed : 0.0;
  };
  std::map<double, StateSpace> known;
  const auto form_at = [&](double psi) -> const StateSpace& {
    const auto found = known.find(psi);
    if (found != known.end()) return found->second;
    const auto all = static_cast<long>(azimuths) + static_cast<long>(options.at.size());
    observer.progress("linearize", std::min(static_cast<long>(known.size()) + 1, all), all);
    return known.emplace(psi, model.state_space(time_of(psi))).first->second;
  };
  NamedForm periodic{"state_space",          "x_dot = A x + B u, y = C x + D u over the azimuth",
                     model.states(),         column_signals(model),
                     input_output.outputs(), AzimuthSeries(form_at, azimuths, harmonics)};
  if (!has_period)
    result.azimuths = {start_azimuth};
  else
    result.azimuths = options.at.empty() ? periodic.series.azimuths() : options.at;
  result.is_constant =
      std::max(periodic.series.variation(), periodic.series.residual()) < constant_tolerance;
  result.series_azimuths = azimuths;
  if (!has_period && (options.hill || options.lyapunov_floquet))
    throw InputError(
        "linearize.forms: nothing repeats where the rotor stands still; hint: state_space is "
        "constant there, without hill and lyapunov_floquet");
  if (options.average && !options.multiblade && has_period && !result.is_constant)
    observer.note(
        "note: the average of rotating coordinates loses what couples tower and blades; hint: "
        "linearize.forms with multiblade and average for three and more blades, with hill or "
        "lyapunov_floquet for less");
  result.outputs.resize(static_cast<Eigen::Index>(result.azimuths.size()),
                        static_cast<Eigen::Index>(input_output.outputs().size()));
  for (std::size_t i = 0; i < result.azimuths.size(); ++i) {
    const double t = time_of(result.azimuths[i]);
    result.outputs.row(static_cast<Eigen::Index>(i)) = model.operating_outputs(t).transpose();
    if (options.descriptor) result.descriptors.push_back(model.descriptor(t));
  }
  const auto give_at_azimuths = [&](NamedForm& form, const auto& item) {
    for (const double psi : result.azimuths) form.at_azimuths.push_back(item(psi));
  };
  give_at_azimuths(periodic, form_at);
  if (options.multiblade) {
    const Multiblade multiblade(model);
    const auto turned_at = [&](double psi) {
      return multiblade.transform(has_period ? psi : start_azimuth, form_at(psi));
    };
    NamedForm turned{"multiblade",         "in multiblade coordinates over the azimuth",
                     multiblade.states(),  multiblade.inputs(),
                     multiblade.outputs(), AzimuthSeries(turned_at, azimuths, harmonics)};
    give_at_azimuths(turned, turned_at);
    if (options.average) result.forms.push_back(average_of(turned));
    result.forms.push_back(std::move(turned));
  } else if (options.average) {
    result.forms.push_back(average_of(periodic));
  }
  if (options.hill) {
    const int h = options.hill_harmonics;
    result.forms.push_back({"hill", "harmonic lifting (Hill): constant",
                            repeated(periodic.states, h), repeated(periodic.inputs, h),
                            repeated(periodic.outputs, h),
                            AzimuthSeries({hill_form(periodic.series, result.rotor_speed, h)},
                                          periodic.series.residual())});
  }
  if (options.lyapunov_floquet) {
    const LyapunovFloquet floquet(periodic.series, result.rotor_speed, azimuths,
                                  options.lyapunov_floquet_states, options.lyapunov_floquet_steps);
    if (!floquet.remark().empty()) observer.note("note: " + floquet.remark());
    const auto constant_at = [&](double psi) { return floquet.form(psi); };
    result.forms.push_back({"lyapunov_floquet",
                            "Lyapunov-Floquet coordinates q: A is constant, B and C periodic",
                            floquet.states(), periodic.inputs, periodic.outputs,
                            AzimuthSeries(constant_at, azimuths, harmonics)});
    give_at_azimuths(result.forms.back(), constant_at);
    const std::vector<system::Signal> states = signals_of(periodic.states);
    const auto map_at = [&](double psi) { return floquet.transformation(psi); };
    result.forms.push_back({"lyapunov_floquet_map",
                            "q = B x and x = C q, x the states of state_space", floquet.states(),
                            states, states, AzimuthSeries(map_at, azimuths, harmonics)});
    give_at_azimuths(result.forms.back(), map_at);
  }
  if (options.order > 0) {
    std::vector<NamedForm> reduced;
    if (result.is_constant) {
      NamedForm constant = average_of(periodic);
      constant.name = periodic.name;
      reduced.push_back(reduced_of(constant, options, observer));
    } else {
      for (const NamedForm& form : result.forms)
        if (form.series.harmonics() == 0 && form.series.samples().empty())
          reduced.push_back(reduced_of(form, options, observer));
    }
    if (reduced.empty())
      throw InputError(
          "linearize.reduce: there is no constant form; hint: linearize.forms with average or "
          "hill");
    result.forms.insert(result.forms.end(), reduced.begin(), reduced.end());
  }
  if (options.state_space) result.forms.insert(result.forms.begin(), std::move(periodic));
  return result;
}

}  // namespace samara::linear
