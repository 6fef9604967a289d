#include "samara/model/changing_wind.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "samara/base/error.hpp"
#include "samara/base/format.hpp"
#include "samara/math/autodiff.hpp"

namespace samara::model {
namespace {

using Sample = elements::ChangingWind::Sample;
using std::numbers::pi;

/// Standard deviation of the wind along its direction, normal turbulence model.
double deviation(const GustDefinition& gust, double wind) {
  return gust.turbulence * (0.75 * wind + 5.6);
}

/// Longitudinal scale parameter Lambda_1 of the turbulence [m].
double scale_at(double height) { return 0.7 * std::min(height, 60.0); }

/// The two points around a coordinate of a grid, and the weight of the second one.
struct Cell {
  int first = 0, second = 0;
  double weight = 0.0;
};

/// In units of the grid, from 0 to `last`.
Cell cell_at(double x, int last) {
  const int first = std::clamp(static_cast<int>(std::floor(x)), 0, std::max(last - 1, 0));
  return {first, std::min(first + 1, last), x - first};
}

class Change final : public elements::ChangingWind {
 public:
  Change(const WindChange& change, const elements::MeanWind& mean, double shear_length,
         const GustSite& site)
      : change_(change), mean_(mean), shear_length_(shear_length), site_(site) {}

  Sample at(const Vector3& place, double t) const override {
    const elements::MeanWind wind = mean_at(t);
    if (change_.box && !change_.box->is_fluctuation) return turned_box(wind, place, t);
    using Place = math::Dual<3>;
    Vec3<Place> x;
    for (int i = 0; i < 3; ++i) x(i) = math::independent<3>(place(i), i);
    const Vec3<Place> v = wind.at<Place>(x);
    Sample sample;
    for (int i = 0; i < 3; ++i) {
      sample.velocity(i) = v(i).value();
      sample.gradient.row(i) = v(i).derivatives().transpose();
    }
    if (change_.box) {
      const Sample box = turned_box(wind, place, t);
      sample.velocity += box.velocity;
      sample.gradient += box.gradient;
    }
    return sample;
  }

 private:
  elements::MeanWind mean_at(double t) const {
    elements::MeanWind wind = mean_;
    const auto take = [t](const std::optional<math::TimeCurve>& curve, double& value,
                          double factor = 1.0) {
      if (curve) value = curve->at(t).value * factor;
    };
    take(change_.speed, wind.speed);
    take(change_.direction, wind.direction);
    take(change_.upflow, wind.upflow);
    take(change_.exponent, wind.exponent);
    if (change_.exponent) wind.profile = elements::WindProfile::power;
    // Shears are parts of the speed.
    if (mean_.speed > 0.0) {
      wind.shear_left *= wind.speed / mean_.speed;
      wind.shear_up *= wind.speed / mean_.speed;
    }
    const double per_length = shear_length_ > 0.0 ? wind.speed / shear_length_ : 0.0;
    take(change_.shear_left, wind.shear_left, per_length);
    take(change_.shear_up, wind.shear_up, per_length);
    take(change_.gust, wind.gust);
    if (!change_.standard) return wind;
    const GustState gust = gust_at(*change_.standard, site_, t);
    wind.gust += gust.speed;
    wind.direction += gust.direction;
    wind.shear_up += gust.shear_up;
    wind.shear_left += gust.shear_left;
    return wind;
  }

  /// The box moves along the direction of the mean wind.
  Sample turned_box(const elements::MeanWind& wind, const Vector3& place, double t) const {
    Matrix3 axes;  // columns: along the wind, to the left, up
    axes.col(0) = Vector3(-std::sin(wind.direction), std::cos(wind.direction), 0.0);
    axes.col(1) = Vector3(-std::cos(wind.direction), -std::sin(wind.direction), 0.0);
    axes.col(2) = Vector3::UnitZ();
    Sample sample = change_.box->at(axes.transpose() * place, t);
    sample.velocity = axes * sample.velocity;
    sample.gradient = axes * sample.gradient * axes.transpose();
    return sample;
  }

  WindChange change_;
  elements::MeanWind mean_;
  double shear_length_;
  GustSite site_;
};

}  // namespace

Sample WindBox::at(const Vector3& place, double t) const {
  double instant = (t + (front - place(0)) / speed) / step;
  Cell time;
  if (is_periodic) {
    instant -= std::floor(instant / times) * times;
    time = {std::min(static_cast<int>(instant), times - 1), 0, 0.0};
    time.second = (time.first + 1) % times;
    time.weight = instant - time.first;
  } else {
    if (!(instant >= 0.0 && instant <= times - 1))
      throw DomainError("the box of turbulence has no wind at t = " + general(t, 6) + " s, " +
                        general(place(0), 4) + " m downwind of the tower");
    time = cell_at(instant, times - 1);
  }
  const double across = place(1) / width + 0.5 * (columns - 1);
  double up = (place(2) - bottom) / height;
  const bool is_below = up < 0.0;
  if (is_below) up = 0.0;
  if (!(across >= 0.0 && across <= columns - 1 && up <= rows - 1))
    throw DomainError("a place " + general(place(1), 4) + " m to the left and " +
                      general(place(2), 4) +
                      " m above the ground is outside the box of turbulence");
  const Cell column = cell_at(across, columns - 1);
  const Cell row = cell_at(up, rows - 1);
  const auto value = [&](int i, int j, int k, int component) {
    const auto index = ((static_cast<std::size_t>(i) * static_cast<std::size_t>(rows) +
                         static_cast<std::size_t>(j)) *
                            static_cast<std::size_t>(columns) +
                        static_cast<std::size_t>(k)) *
                           3 +
                       static_cast<std::size_t>(component);
    return static_cast<double>(values[index]);
  };
  Sample sample;
  for (int c = 0; c < 3; ++c) {
    // Values at the two instants, and their derivatives by the units of the grid.
    std::array<double, 2> v{}, by_column{}, by_row{};
    for (std::size_t n = 0; n < 2; ++n) {
      const int i = n == 0 ? time.first : time.second;
      const double v00 = value(i, row.first, column.first, c);
      const double v01 = value(i, row.first, column.second, c);
      const double v10 = value(i, row.second, column.first, c);
      const double v11 = value(i, row.second, column.second, c);
      const double low = v00 + column.weight * (v01 - v00);
      const double high = v10 + column.weight * (v11 - v10);
      v[n] = low + row.weight * (high - low);
      by_row[n] = high - low;
      by_column[n] = (1.0 - row.weight) * (v01 - v00) + row.weight * (v11 - v10);
    }
    const auto mix = [&](const std::array<double, 2>& pair) {
      return pair[0] + time.weight * (pair[1] - pair[0]);
    };
    sample.velocity(c) = mix(v);
    sample.gradient(c, 0) = -(v[1] - v[0]) / (speed * step);
    sample.gradient(c, 1) = mix(by_column) / width;
    sample.gradient(c, 2) = is_below ? 0.0 : mix(by_row) / height;
  }
  return sample;
}

double gust_duration(const GustDefinition& gust) {
  switch (gust.type) {
    case GustDefinition::Type::operating:
      return 10.5;
    case GustDefinition::Type::direction:
      return 6.0;
    case GustDefinition::Type::coherent:
      return 10.0;
    default:
      return 12.0;
  }
}

/// IEC 61400-1:2005, equations (17) to (28).
GustState gust_at(const GustDefinition& gust, const GustSite& site, double t) {
  using Type = GustDefinition::Type;
  const double T = gust_duration(gust);
  double s = (t - gust.start) / T;
  if (s <= 0.0) return {};
  const double sign = gust.is_negative ? -1.0 : 1.0;
  const double sigma = deviation(gust, site.wind);
  const double wide = site.diameter / scale_at(site.height);
  GustState state;
  switch (gust.type) {
    case Type::operating: {
      if (s >= 1.0) return {};
      const double extreme = 0.8 * 1.4 * gust.reference_speed;  // V_e1 at the hub
      const double rise = std::min(1.35 * (extreme - site.wind), 3.3 * sigma / (1.0 + 0.1 * wide));
      state.speed = -0.37 * rise * std::sin(3.0 * pi * s) * (1.0 - std::cos(2.0 * pi * s));
      break;
    }
    case Type::direction: {
      const double most = std::min(4.0 * std::atan(sigma / (site.wind * (1.0 + 0.1 * wide))), pi);
      state.direction = sign * 0.5 * most * (1.0 - std::cos(pi * std::min(s, 1.0)));
      break;
    }
    case Type::coherent: {
      constexpr double rise = 15.0;                                     // [m/s]
      const double turn = site.wind < 4.0 ? pi : 4.0 * pi / site.wind;  // 720 degrees by V_hub
      const double part = 0.5 * (1.0 - std::cos(pi * std::min(s, 1.0)));
      state.speed = rise * part;
      state.direction = sign * turn * part;
      break;
    }
    default: {
      if (s >= 1.0) return {};
      constexpr double beta = 6.4;
      const double shear = sign * (2.5 + 0.2 * beta * sigma * std::pow(wide, 0.25)) /
                           site.diameter * (1.0 - std::cos(2.0 * pi * s));
      (gust.type == Type::vertical_shear ? state.shear_up : state.shear_left) = shear;
    }
  }
  return state;
}

std::shared_ptr<const elements::ChangingWind> make_changing_wind(const WindChange& change,
                                                                 const elements::MeanWind& mean,
                                                                 double shear_length,
                                                                 const GustSite& site) {
  return std::make_shared<Change>(change, mean, shear_length, site);
}

}  // namespace samara::model
