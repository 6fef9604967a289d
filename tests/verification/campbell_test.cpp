// Campbell diagrams: the lines of the NREL 5 MW turbine from 0 to 14 rpm, its whirl against
// multiblade coordinates at all speeds, and a band of parametric instability in time.
#include "samara/simulation/campbell.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <boost/test/unit_test.hpp>

#include "samara/simulation/steady_state.hpp"

#include "growth.hpp"
#include "multiblade.hpp"
#include "record.hpp"

using namespace samara;
using namespace samara::test;

namespace {

struct Diagram {
  std::vector<simulation::CampbellPoint> points;
  std::vector<simulation::CampbellLine> lines;
};

std::vector<std::string> settings_at(const std::vector<std::string>& settings, double rpm) {
  return with(settings, {"shaft.speed_rpm=" + std::to_string(rpm)});
}

/// The points of a case at rotor speeds [rpm].
Diagram sweep(const std::string& name, const std::vector<std::string>& settings,
              const std::vector<double>& speeds) {
  Diagram diagram;
  analysis::ModeTracker tracker;
  analysis::Observer observer;
  for (const double rpm : speeds) {
    const io::Case input = structure(name, settings_at(settings, rpm));
    const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
    analysis::TrimOptions options = simulation::trim_options(input);
    if (rpm == 0.0) options.harmonics = 0;
    const analysis::Trim trim = analysis::find_trim(system, options, observer);
    diagram.points.push_back(
        simulation::find_campbell_point(system, trim, input.floquet, PETSC_COMM_SELF, observer));
    diagram.points.back().place.value = rpm;
    tracker.add(diagram.points.size() - 1, diagram.points.back().signatures);
  }
  diagram.lines = simulation::name_lines(diagram.points, tracker.lines());
  return diagram;
}

std::vector<double> one_to(int last) {
  std::vector<double> values;
  for (int i = 1; i <= last; ++i) values.push_back(i);
  return values;
}

const std::vector<std::string>& coarse() {
  static const std::vector<std::string> settings{"blades.elements=2", "blades.order=2",
                                                 "tower.elements=2", "tower.order=2"};
  return settings;
}

double frequency_at(const Diagram& diagram, const analysis::TrackedMode& tracked) {
  const simulation::CampbellPoint& point = diagram.points[tracked.point];
  return std::abs(tracked_exponent(point.modes[tracked.mode].exponent, tracked, point.rotor_speed)
                      .imag()) /
         (2.0 * pi);
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_line_of_the_nrel5mw_jumps_from_rest_to_14_rpm) {
  // Under gravity, with tilt and cone. A line that took another mode or another copy would jump by
  // more than 1 rpm or 0.017 Hz; the frequencies themselves bend by less than half of it a step.
  std::vector<double> speeds = one_to(14);
  speeds.insert(speeds.begin(), 0.0);
  const Diagram diagram = sweep("nrel5mw/land", coarse(), speeds);
  std::map<std::string, const simulation::CampbellLine*> lines;
  for (const simulation::CampbellLine& line : diagram.lines)
    if (line.modes.size() == speeds.size()) lines[line.name] = &line;
  BOOST_TEST(lines.size() >= 11U);
  for (const char* name :
       {"1st tower side-side", "1st tower fore-aft", "shaft torsion", "1st blade flap regressive",
        "1st blade flap progressive", "1st blade flap collective", "1st blade lead-lag regressive",
        "1st blade lead-lag progressive", "2nd blade flap regressive", "2nd blade flap progressive",
        "2nd blade flap collective"})
    BOOST_TEST(lines.count(name) == 1U, name);
  for (const auto& [name, line] : lines)
    for (std::size_t i = 1; i + 1 < line->modes.size(); ++i) {
      const double bend = frequency_at(diagram, line->modes[i - 1]) -
                          2.0 * frequency_at(diagram, line->modes[i]) +
                          frequency_at(diagram, line->modes[i + 1]);
      BOOST_TEST(
          std::abs(bend) < 0.5 / 60.0 + 4e-3 * frequency_at(diagram, line->modes[i]),
          name << " at " << diagram.points[line->modes[i].point].place.value << " rpm: " << bend);
    }
  // The limit from above names the modes at rest, where the flap modes are 0.03 Hz apart.
  for (const char* name : {"1st blade flap regressive", "1st blade flap progressive"})
    BOOST_TEST(diagram.points[lines.at(name)->modes.front().point].place.value == 0.0);
}

BOOST_AUTO_TEST_CASE(whirl_is_named_as_multiblade_coordinates_see_it) {
  // Without gravity and tilt the tangents are constant in multiblade coordinates. The motion
  // ac cos psi + as sin psi of the blades is a wave ahead of the rotor with ac + i as, one behind
  // it with ac - i as.
  const std::vector<std::string> settings = with(coarse(), {"gravity=0", "shaft.tilt_deg=0"});
  const std::vector<double> speeds = one_to(14);
  const Diagram diagram = sweep("nrel5mw/land", settings, speeds);
  // The modes in multiblade coordinates at each speed, and the size of a blade's part.
  std::vector<std::pair<std::vector<MultibladeMode>, Eigen::Index>> seen;
  for (const double rpm : speeds) {
    const io::Case input = structure("nrel5mw/land", settings_at(settings, rpm));
    const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
    analysis::Observer observer;
    const analysis::Trim trim = analysis::find_trim(system, {}, observer);
    const Multiblade multiblade(system);
    seen.emplace_back(slow_modes(multiblade.at(0.0, trim.solution), 2.0, 40.0),
                      multiblade.blade_size());
  }
  int compared = 0;
  for (const simulation::CampbellLine& line : diagram.lines) {
    const bool is_progressive = line.name.find(" progressive") != std::string::npos;
    if (!is_progressive && line.name.find(" regressive") == std::string::npos) continue;
    for (const analysis::TrackedMode& tracked : line.modes) {
      const simulation::CampbellPoint& point = diagram.points[tracked.point];
      const simulation::CampbellMode& mode = point.modes[tracked.mode];
      const auto& [modes, size] = seen[tracked.point];
      if (mode.fixed_frame_frequency > 20.0 || !std::isfinite(mode.fixed_frame_frequency)) continue;
      const Complex wanted(mode.exponent.real(), mode.fixed_frame_frequency);
      const auto found = std::ranges::min_element(
          modes, {}, [&](const MultibladeMode& one) { return std::abs(one.exponent - wanted); });
      BOOST_TEST(std::abs(found->exponent - wanted) < 2e-3 * std::abs(wanted),
                 line.name << " at " << point.place.value << " rpm");
      const Eigen::VectorXcd cosine = found->shape.segment(size, size);
      const Eigen::VectorXcd sine = found->shape.segment(2 * size, size);
      const double ahead = (cosine + Complex(0.0, 1.0) * sine).norm();
      const double behind = (cosine - Complex(0.0, 1.0) * sine).norm();
      BOOST_TEST((ahead > behind) == is_progressive,
                 line.name << " at " << point.place.value << " rpm: " << ahead << " " << behind);
      ++compared;
    }
  }
  BOOST_TEST(compared >= 4 * 14);
}

BOOST_AUTO_TEST_CASE(a_band_of_instability_grows_inside_and_decays_outside) {
  // Hammond's rotor with two blades: its coefficients are periodic in any axes. `samara campbell`
  // finds a band from 247.2 to 373.0 rpm with a lag damper of 100 N m s/rad; here the transients
  // beside its edges.
  const std::vector<std::string> settings{"blades.count=2", "blades.hinges.0.damping=100"};
  for (const auto& [rpm, grows] :
       {std::pair(240.0, false), {254.0, true}, {366.0, true}, {380.0, false}}) {
    const io::Case input = structure("ground_resonance/hammond", settings_at(settings, rpm));
    const turbine::TurbineSystem system(model::build_turbine(input.turbine), PETSC_COMM_SELF);
    analysis::Observer observer;
    const analysis::Trim trim = analysis::find_trim(system, input.trim, observer);
    const analysis::ModeSet set =
        find_floquet_modes(system, trim.solution, input.floquet, PETSC_COMM_SELF, observer).set;
    // The mode of slowest decay, or of growth.
    std::size_t slowest = 0;
    for (std::size_t m = 0; m < set.modes.size(); ++m)
      if (set.modes[m].resolved &&
          set.modes[m].exponent.real() > set.modes[slowest].exponent.real())
        slowest = m;
    BOOST_TEST((set.modes[slowest].exponent.real() > 0.0) == grows, rpm);
    // At t = 0 of the shape, which is sampled a little later.
    const double t = set.shape_times.front();
    BOOST_TEST_REQUIRE(t < 0.01 * system.period());
    require_exponent(system, trim, {set.modes[slowest], set.shapes[slowest].col(0)},
                     {system.period(), 300, 6}, 5e-3);
  }
}
