#include "samara/analysis/linearization.hpp"

#include <algorithm>
#include <numbers>

#include "samara/analysis/hill.hpp"
#include "samara/analysis/multiblade.hpp"
#include "samara/base/error.hpp"

namespace samara::analysis {
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

NamedForm average_of(const NamedForm& form) {
  NamedForm average = form;
  average.name = form.name + "_average";
  average.description = "mean over the azimuth of " + form.name;
  average.series = AzimuthSeries({form.series.mean()});
  return average;
}

/// Its states are combinations of all.
NamedForm reduced_of(const NamedForm& form, const LinearizeOptions& options) {
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
                        const system::InputOutput& input_output, const PeriodicSolution& solution,
                        double start_azimuth, const LinearizeOptions& options, Observer& observer) {
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
  long count = 0;
  const auto form_at = [&](double psi) {
    observer.progress("linearize", std::min<long>(++count, azimuths), azimuths);
    return model.state_space(time_of(psi));
  };
  NamedForm periodic{"state_space",          "x_dot = A x + B u, y = C x + D u over the azimuth",
                     model.states(),         column_signals(model),
                     input_output.outputs(), AzimuthSeries(form_at, azimuths, harmonics)};
  result.azimuths = periodic.series.azimuths();
  result.is_constant = periodic.series.variation() < constant_tolerance;
  result.outputs.resize(azimuths, static_cast<Eigen::Index>(input_output.outputs().size()));
  for (int i = 0; i < azimuths; ++i) {
    const double t = time_of(result.azimuths[static_cast<std::size_t>(i)]);
    result.outputs.row(i) = model.operating_outputs(t).transpose();
    if (options.descriptor) result.descriptors.push_back(model.descriptor(t));
  }
  if (options.multiblade) {
    const Multiblade multiblade(model);
    NamedForm turned{
        "multiblade",
        "in multiblade coordinates over the azimuth",
        multiblade.states(),
        multiblade.inputs(),
        multiblade.outputs(),
        AzimuthSeries(
            [&](double psi) { return multiblade.transform(psi, model.state_space(time_of(psi))); },
            azimuths, harmonics)};
    if (options.average) result.forms.push_back(average_of(turned));
    result.forms.push_back(std::move(turned));
  } else if (options.average) {
    result.forms.push_back(average_of(periodic));
  }
  if (options.hill && has_period) {
    const int h = options.hill_harmonics;
    result.forms.push_back({"hill", "harmonic lifting (Hill): constant",
                            repeated(periodic.states, h), repeated(periodic.inputs, h),
                            repeated(periodic.outputs, h),
                            AzimuthSeries({hill_form(periodic.series, result.rotor_speed, h)})});
  }
  if (options.order > 0) {
    std::vector<NamedForm> reduced;
    if (result.is_constant) {
      NamedForm constant = average_of(periodic);
      constant.name = periodic.name;
      reduced.push_back(reduced_of(constant, options));
    } else {
      for (const NamedForm& form : result.forms)
        if (form.series.coefficients().size() == 1) reduced.push_back(reduced_of(form, options));
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

}  // namespace samara::analysis
