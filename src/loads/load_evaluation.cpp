#include "samara/loads/load_evaluation.hpp"

#include "samara/base/error.hpp"

namespace samara::loads {
namespace {

void add_harmonics(const LoadSeries& series, const Eigen::VectorXd& azimuth_deg,
                   const LoadEvaluationOptions& options, LoadEvaluation& result) {
  try {
    if (azimuth_deg.size() == 0)
      throw InputError(
          "harmonics: the time series has no channel Azimuth; hint: name it in "
          "transient.output.channels");
    result.harmonics = compute_harmonics(series, azimuth_deg, options.harmonics);
  } catch (const InputError& error) {
    if (options.harmonics_are_asked_for) throw;
    result.why_no_harmonics = error.what();
  }
}

}  // namespace

DamageOptions LoadEvaluationOptions::damage_of(Eigen::Index channel) const {
  DamageOptions options{exponents, frequency, {}};
  if (!goodman.empty()) options.goodman = goodman.at(static_cast<std::size_t>(channel));
  return options;
}

LoadEvaluation evaluate_loads(const LoadSeries& series, const Eigen::VectorXd& azimuth_deg,
                              const LoadEvaluationOptions& options) {
  LoadEvaluation result;
  result.statistics = compute_statistics(series);
  result.events = find_extreme_events(series);
  add_harmonics(series, azimuth_deg, options, result);
  for (Eigen::Index c = 0; c < series.values.cols(); ++c)
    at_place(series.names[static_cast<std::size_t>(c)], [&] {
      result.cycles.push_back(count_cycles(series, c));
      result.tables.push_back(
          tabulate_cycles(result.cycles.back(), options.range_bins, options.mean_bins));
      result.damage.push_back(compute_damage_equivalent_loads(
          result.cycles.back(), duration(series), options.damage_of(c)));
    });
  return result;
}

std::vector<std::vector<double>> evaluate_lifetime(const std::vector<LoadEvaluation>& evaluations,
                                                   const std::vector<double>& durations,
                                                   const std::vector<double>& hours,
                                                   const std::vector<std::string>& names,
                                                   const LoadEvaluationOptions& options,
                                                   std::optional<double> equivalent_cycles) {
  std::vector<std::vector<double>> loads;
  for (std::size_t c = 0; c < names.size(); ++c) {
    std::vector<LoadCase> cases;
    for (std::size_t i = 0; i < evaluations.size(); ++i)
      cases.push_back({evaluations[i].cycles.at(c), durations.at(i), hours.at(i)});
    loads.push_back(at_place(names[c], [&] {
      return compute_lifetime_loads(cases, options.damage_of(static_cast<Eigen::Index>(c)),
                                    equivalent_cycles);
    }));
  }
  return loads;
}

}  // namespace samara::loads
