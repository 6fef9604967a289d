#include "start_predictor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace samara::simulation {
namespace {

/// Farthest extrapolation, in distances of the points before; longest change by a secant, and
/// shortest new secant, in its lengths.
constexpr double farthest = 2.5;
constexpr double longest_change = 4.0;
constexpr double shortest_secant = 0.05;

bool have_one_size(const Solved& a, const Solved& b) {
  return a.coefficients.cols() == b.coefficients.cols();
}

}  // namespace

void StartPredictor::Slope::add_change(double change, Eigen::MatrixXd& to) const {
  if (value.cols() == to.cols() && std::abs(change) <= longest_change * length)
    to += change * value;
}

void StartPredictor::Slope::take(const Solved& a, const Solved& b, double change) {
  // A short secant has the errors of the steady states.
  if (change == 0.0 || std::abs(change) < shortest_secant * length) return;
  value = (b.coefficients - a.coefficients) / change;
  length = std::max(0.5 * length, std::abs(change));
}

void StartPredictor::add(Solved solved) {
  if (last_ && last_->wind == solved.wind && have_one_size(*last_, solved)) {
    if (last_->pitch == solved.pitch)
      speed_slope_.take(*last_, solved, solved.speed - last_->speed);
    if (last_->speed == solved.speed)
      pitch_slope_.take(*last_, solved, solved.pitch - last_->pitch);
  }
  last_ = std::move(solved);
}

void StartPredictor::finish_point() {
  before_ = std::move(point_);
  point_ = last_;
}

std::optional<Eigen::MatrixXd> StartPredictor::predict(double wind, double speed,
                                                       double pitch) const {
  if (!last_) return std::nullopt;
  Solved start = *last_;
  if (wind != last_->wind && point_ && before_ && have_one_size(*point_, *before_) &&
      point_->wind != before_->wind) {
    const double share = (wind - point_->wind) / (point_->wind - before_->wind);
    if (std::abs(share) <= farthest) {
      start.speed = point_->speed + share * (point_->speed - before_->speed);
      start.pitch = point_->pitch + share * (point_->pitch - before_->pitch);
      start.coefficients =
          point_->coefficients + share * (point_->coefficients - before_->coefficients);
    }
  }
  speed_slope_.add_change(speed - start.speed, start.coefficients);
  pitch_slope_.add_change(pitch - start.pitch, start.coefficients);
  return std::move(start.coefficients);
}

}  // namespace samara::simulation
