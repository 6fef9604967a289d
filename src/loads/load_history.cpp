#include "samara/loads/load_history.hpp"

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

/// The first row that is not finite, or their number.
Eigen::Index first_bad_row(const Eigen::Ref<const Eigen::VectorXd>& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (!std::isfinite(values(i))) return i;
  return values.size();
}

void check_times(const LoadHistory& history, Faults& faults) {
  const Eigen::VectorXd& times = history.times;
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
  if (history.is_periodic() && !(times(last) - times(0) < history.period))
    faults.add() << "time: the rows last " << times(last) - times(0)
                 << " s, no less than the period of " << history.period
                 << " s; the first row must not come again at the end";
}

void check_values(const LoadHistory& history, Faults& faults) {
  for (Eigen::Index c = 0; c < history.values.cols(); ++c)
    if (const Eigen::Index bad = first_bad_row(history.values.col(c)); bad < history.values.rows())
      faults.add() << history.names[static_cast<std::size_t>(c)] << ": row " << bad + 1 << " (time "
                   << history.times(bad) << " s) is not a finite number";
}

}  // namespace

void check(const LoadHistory& history) {
  if (history.values.rows() != history.times.size() ||
      history.values.cols() != static_cast<Eigen::Index>(history.names.size()))
    throw InternalError("a history's names, times and values differ in size");
  Faults faults;
  if (!std::isfinite(history.period) || history.period < 0.0)
    faults.add() << "the period must be a number >= 0 s, not " << history.period;
  if (history.names.empty()) faults.add() << "the history has no channel";
  const Eigen::Index least = history.is_periodic() ? 1 : 2;
  if (history.times.size() < least)
    faults.add() << "the history has too few rows: " << history.times.size()
                 << " instead of at least " << least;
  faults.raise();
  check_times(history, faults);
  check_values(history, faults);
  faults.raise();
}

double duration(const LoadHistory& history) {
  if (history.is_periodic()) return history.period;
  return history.times(history.times.size() - 1) - history.times(0);
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
