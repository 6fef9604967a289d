#include "history_legs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "samara/turbine/turbine_events.hpp"
#include "samara/turbine/turbine_system.hpp"

namespace samara::drivers {
namespace {

/// Of a step: an event this close to an instant of the grid is there. A step that short would lose
/// its digits.
constexpr double closest_event = 1e-3;

}  // namespace

model::Turbine operated_turbine(const io::Case& input) {
  model::Turbine turbine = model::build_turbine(input.turbine);
  const io::TransientCase& transient = input.transient;
  const double duration = transient.options.duration;
  if (transient.speed) turbine.operation.turning.emplace(*transient.speed, duration);
  if (transient.pitch) turbine.operation.pitch.assign(turbine.blades.size(), transient.pitch);
  turbine.operation.yaw = transient.yaw;
  turbine.operation.teeter = transient.teeter;
  return turbine;
}

model::Turbine turbine_after(const io::TransientCase& transient, model::Turbine turbine,
                             const std::vector<double>& fired) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < fired.size(); ++i)
    if (std::isfinite(fired[i])) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&fired](std::size_t i) { return fired[i]; });
  for (const std::size_t i : order)
    turbine = turbine::apply_event(turbine, transient.events[i], fired[i]);
  return turbine;
}

HistoryLegs::HistoryLegs(const io::TransientCase& transient, const model::Turbine& turbine,
                         analysis::TransientStart start, std::vector<double> fired, int generator,
                         HistoryRecorder& recorder, io::HistoryFile& file)
    : transient_(transient),
      turbine_(turbine_after(transient, turbine, fired)),
      start_(std::move(start)),
      fired_(std::move(fired)),
      generator_(generator),
      recorder_(recorder),
      file_(file) {
  fired_.resize(transient_.events.size(), never);
}

analysis::TransientRun HistoryLegs::run() {
  while (true) {
    file_.note_events(fired_);
    const std::optional<double> stop = next_time();
    if (stop && *stop <= start_.time) {
      fire_at(*stop);
      continue;
    }
    const analysis::TransientRun leg = run_leg(stop, to_watch());
    if (recorder_.crossing()) {
      pass(*recorder_.crossing(), leg);
      continue;
    }
    start_ = leg.end;
    if (leg.reason != analysis::TransientEnd::stopped) {
      total_.end = leg.end;
      total_.reason = leg.reason;
      return total_;
    }
    fire_at(*stop);
  }
}

void HistoryLegs::fire_at(double time) {
  for (std::size_t i = 0; i < fired_.size(); ++i)
    if (const std::optional<double>& at = transient_.events[i].trigger.time;
        !std::isfinite(fired_[i]) && at && on_grid(*at) == time)
      fire(i);
}

/// The time of an event, or the instant of the grid that is next to it.
double HistoryLegs::on_grid(double time) const {
  const double step = transient_.options.step;
  const double nearest = start_.origin + std::round((time - start_.origin) / step) * step;
  return std::abs(time - nearest) < closest_event * step ? nearest : time;
}

analysis::TransientRun HistoryLegs::run_leg(std::optional<double> stop,
                                            const std::vector<std::size_t>& watch) {
  const turbine::TurbineSystem system(turbine_, PETSC_COMM_SELF);
  recorder_.begin_leg(system, watch);
  analysis::TransientOptions options = transient_.options;
  options.stop_at = stop;
  analysis::TransientRun leg = analysis::run_transient(system, start_, options, recorder_);
  total_.method = leg.method;
  total_.steps += leg.steps;
  total_.newton_steps += leg.newton_steps;
  total_.factorizations += leg.factorizations;
  total_.cuts += leg.cuts;
  return leg;
}

/// Goes to where a state event came, from the step before it.
void HistoryLegs::pass(Crossing crossing, const analysis::TransientRun& leg) {
  const double time = std::min(on_grid(crossing.time), leg.end.time);
  if (leg.steps > 0) start_ = leg.before;
  if (leg.steps > 0 && time > start_.time) start_ = run_leg(time, {}).end;
  fire(crossing.event);
}

void HistoryLegs::fire(std::size_t i) {
  const turbine::TurbineEvent& event = transient_.events[i];
  fired_[i] = start_.time;
  turbine_ = turbine::apply_event(turbine_, event, start_.time);
  if (!event.generator_off) return;
  for (analysis::HeldCoordinate& held : start_.held)
    if (held.unknown == generator_) held.load = 0.0;
}

std::optional<double> HistoryLegs::next_time() const {
  std::optional<double> next;
  for (std::size_t i = 0; i < fired_.size(); ++i) {
    const std::optional<double>& time = transient_.events[i].trigger.time;
    if (!std::isfinite(fired_[i]) && time && (!next || on_grid(*time) < *next))
      next = on_grid(*time);
  }
  return next;
}

std::vector<std::size_t> HistoryLegs::to_watch() const {
  std::vector<std::size_t> watched;
  for (std::size_t i = 0; i < fired_.size(); ++i)
    if (!std::isfinite(fired_[i]) && !transient_.events[i].trigger.time) watched.push_back(i);
  return watched;
}

}  // namespace samara::drivers
