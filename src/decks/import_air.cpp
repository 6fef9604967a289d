#include "import_air.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "samara/model/airfoil.hpp"
#include "samara/model/reference_line.hpp"

namespace samara::decks {
namespace {

/// Angles closer than this are the same [rad].
constexpr double same_angle = 1e-9;

double interpolate_at(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto next = std::ranges::lower_bound(x, at);
  if (next == x.begin()) return y.front();
  if (next == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(next - x.begin());
  return y[i - 1] + (at - x[i - 1]) / (x[i] - x[i - 1]) * (y[i] - y[i - 1]);
}

}  // namespace

std::string name_airfoil(const std::string& text, const Airfoils& others) {
  constexpr std::size_t most_letters = 60;
  std::string name;
  for (const char c : text.substr(0, most_letters)) {
    const bool is_kept = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '-' || c == '+' || c == ' ';
    name += is_kept ? c : '_';
  }
  while (name.ends_with(' ')) name.pop_back();
  name.erase(0, std::min(name.find_first_not_of(' '), name.size()));
  if (name.empty()) name = "airfoil";
  const std::string first = name;
  for (int number = 2; others.contains(name); ++number) name = first + "_" + std::to_string(number);
  return name;
}

SectionPlacement::SectionPlacement(const model::BeamDefinition& blade) : blade_(blade) {}

void SectionPlacement::place(const AeroPoint& point, model::AeroSectionDefinition& section) const {
  constexpr int most_steps = 100;
  constexpr double tolerance = 1e-13;  // of the length
  const model::ReferenceLine line("blades", blade_);
  double at = std::clamp(point.center(0) / blade_.length, 0.0, 1.0);
  for (int step = 0; step < most_steps; ++step) {
    const model::ReferenceLine::Station station = line.at(at);
    const double along = station.C_ab.col(0).dot(Vector3(point.center - station.x)) / blade_.length;
    const double next = std::clamp(at + along, 0.0, 1.0);
    const bool is_there = std::abs(next - at) <= tolerance;
    if (!is_there) at = next;
    if (is_there) break;
  }
  const double structural = model::interpolate_section(blade_, at).twist;
  const model::ReferenceLine::Station station = line.at(at, structural);
  const Vector3 offset = station.C_ab.transpose() * (point.center - station.x);
  const Vector3 forward = station.C_ab.transpose() * point.forward;
  section.at = at;
  section.center = {offset(1), offset(2)};
  for (double& component : section.center)
    if (std::abs(component) <= tolerance * blade_.length) component = 0.0;
  section.twist = structural + std::atan2(-forward(2), forward(1));
}

std::vector<double> merge_angles(std::vector<double> angles) {
  std::ranges::sort(angles);
  std::vector<double> merged;
  for (const double angle : angles)
    if (merged.empty() || angle - merged.back() >= same_angle) merged.push_back(angle);
  return merged;
}

model::PolarDefinition mix_polars(const model::PolarDefinition& a, const model::PolarDefinition& b,
                                  double weight) {
  std::vector<double> angles = a.angles;
  angles.insert(angles.end(), b.angles.begin(), b.angles.end());
  model::PolarDefinition mixed;
  mixed.reynolds = a.reynolds == b.reynolds ? a.reynolds : 0.0;
  mixed.angles = merge_angles(std::move(angles));
  for (const double angle : mixed.angles)
    for (const auto& values : {&model::PolarDefinition::lift, &model::PolarDefinition::drag,
                               &model::PolarDefinition::moment})
      (mixed.*values)
          .push_back((1.0 - weight) * interpolate_at(a.angles, a.*values, angle) +
                     weight * interpolate_at(b.angles, b.*values, angle));
  return mixed;
}

model::AirfoilDefinition mix_airfoils(const model::AirfoilDefinition& a,
                                      const model::AirfoilDefinition& b, double weight) {
  model::AirfoilDefinition mixed;
  if (a.thickness && b.thickness)
    mixed.thickness = (1.0 - weight) * *a.thickness + weight * *b.thickness;
  if (a.polars.size() == 1 && b.polars.size() == 1) {
    mixed.polars.push_back(mix_polars(a.polars[0], b.polars[0], weight));
    return mixed;
  }
  std::set<double> numbers;
  for (const model::AirfoilDefinition* airfoil : {&a, &b})
    for (const model::PolarDefinition& polar : airfoil->polars)
      if (polar.reynolds > 0.0) numbers.insert(polar.reynolds);
  for (const double reynolds : numbers) {
    model::PolarDefinition polar =
        model::blend(model::polar_at(a, reynolds), model::polar_at(b, reynolds), weight);
    polar.reynolds = reynolds;
    mixed.polars.push_back(std::move(polar));
  }
  return mixed;
}

}  // namespace samara::decks
