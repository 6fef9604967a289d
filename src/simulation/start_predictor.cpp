#include "samara/simulation/start_predictor.hpp"

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

void add_change(const StartSlope& slope, double change, Eigen::MatrixXd& to) {
  if (slope.value.cols() == to.cols() && std::abs(change) <= longest_change * slope.length)
    to += change * slope.value;
}

void take_secant(const Solved& a, const Solved& b, double change, StartSlope& slope) {
  // A short secant has the errors of the steady states.
  if (change == 0.0 || std::abs(change) < shortest_secant * slope.length) return;
  slope.value = (b.coefficients - a.coefficients) / change;
  slope.length = std::max(0.5 * slope.length, std::abs(change));
}

}  // namespace

void StartPredictor::add(Solved solved) {
  if (last && last->wind == solved.wind && have_one_size(*last, solved)) {
    if (last->pitch == solved.pitch)
      take_secant(*last, solved, solved.speed - last->speed, speed_slope);
    if (last->speed == solved.speed)
      take_secant(*last, solved, solved.pitch - last->pitch, pitch_slope);
  }
  last = std::move(solved);
}

void StartPredictor::finish_point() {
  before = std::move(point);
  point = last;
}

std::optional<Eigen::MatrixXd> StartPredictor::predict(double wind, double speed,
                                                       double pitch) const {
  if (!last) return std::nullopt;
  Solved start = *last;
  if (wind != last->wind && point && before && have_one_size(*point, *before) &&
      point->wind != before->wind) {
    const double share = (wind - point->wind) / (point->wind - before->wind);
    if (std::abs(share) <= farthest) {
      start.speed = point->speed + share * (point->speed - before->speed);
      start.pitch = point->pitch + share * (point->pitch - before->pitch);
      start.coefficients =
          point->coefficients + share * (point->coefficients - before->coefficients);
    }
  }
  add_change(speed_slope, speed - start.speed, start.coefficients);
  add_change(pitch_slope, pitch - start.pitch, start.coefficients);
  return std::move(start.coefficients);
}

}  // namespace samara::simulation
