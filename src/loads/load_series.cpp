#include "samara/loads/load_series.hpp"

#include <cmath>
#include <sstream>

#include "samara/base/error.hpp"

namespace samara::loads {
namespace {

class Faults {
 public:
  Faults() { text_.precision(10); }
  /// A stream for one more line.
  std::ostream& add() {
    if (!text_.str().empty()) text_ << '\n';
    return text_;
  }
  void raise() const {
    if (!text_.str().empty()) throw InputError(text_.str());
  }

 private:
  std::ostringstream text_;
};

/// The first row that is not finite; if there is none, the number of rows.
Eigen::Index first_bad_row(const Eigen::Ref<const Eigen::VectorXd>& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (!std::isfinite(values(i))) return i;
  return values.size();
}

void check_times(const LoadSeries& series, Faults& faults) {
  const Eigen::VectorXd& times = series.times;
  if (const Eigen::Index bad = first_bad_row(times); bad < times.size()) {
    faults.add() << "time: row " << bad + 1 << " is not a finite number";
    return;
  }
  for (Eigen::Index i = 1; i < times.size(); ++i)
    if (!(times(i) > times(i - 1))) {
      faults.add() << "time: row " << i + 1 << " has " << times(i) << " s after " << times(i - 1)
                   << " s; times must grow";
      return;
    }
  const Eigen::Index last = times.size() - 1;
  if (series.is_periodic() && !(times(last) - times(0) < series.period))
    faults.add() << "time: the rows last " << times(last) - times(0)
                 << " s, no less than the period of " << series.period
                 << " s; the first row must not be repeated at the end";
}

void check_values(const LoadSeries& series, Faults& faults) {
  for (Eigen::Index c = 0; c < series.values.cols(); ++c)
    if (const Eigen::Index bad = first_bad_row(series.values.col(c)); bad < series.values.rows())
      faults.add() << series.names[static_cast<std::size_t>(c)] << ": row " << bad + 1 << " (time "
                   << series.times(bad) << " s) is not a finite number";
}

}  // namespace

void check(const LoadSeries& series) {
  if (series.values.rows() != series.times.size() ||
      series.values.cols() != static_cast<Eigen::Index>(series.names.size()))
    throw InternalError("the names, times and values differ in size");
  Faults faults;
  if (!std::isfinite(series.period) || series.period < 0.0)
    faults.add() << "the period must be a number >= 0 s, not " << series.period;
  if (series.names.empty()) faults.add() << "the time series has no channel";
  const Eigen::Index least = series.is_periodic() ? 1 : 2;
  if (series.times.size() < least)
    faults.add() << "the time series has too few rows: " << series.times.size()
                 << " instead of at least " << least;
  faults.raise();
  check_times(series, faults);
  check_values(series, faults);
  faults.raise();
}

double duration(const LoadSeries& series) {
  if (series.is_periodic()) return series.period;
  return series.times(series.times.size() - 1) - series.times(0);
}

Eigen::VectorXd trapezoidal_weights(const Eigen::VectorXd& points, double period) {
  const Eigen::Index n = points.size();
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(n);
  const auto add_interval = [&](Eigen::Index from, Eigen::Index to, double length) {
    weights(from) += 0.5 * length;
    weights(to) += 0.5 * length;
  };
  for (Eigen::Index i = 1; i < n; ++i) add_interval(i - 1, i, points(i) - points(i - 1));
  if (period > 0.0 && n > 0) add_interval(n - 1, 0, period - (points(n - 1) - points(0)));
  return weights;
}

}  // namespace samara::loads
