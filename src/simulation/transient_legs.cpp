#include "transient_legs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "samara/turbine/turbine_events.hpp"

namespace samara::simulation {
namespace {

/// Relative to a step: an event this close to an instant of the grid is moved onto it. A step of
/// this size would lose its digits.
constexpr double closest_event = 1e-3;

analysis::TransientOptions options_of(const TransientSetup& transient) {
  analysis::TransientOptions options = transient.options;
  // A controller has a memory of its own: a checkpoint would not be a state to continue from.
  const bool has_checkpoints = transient.checkpoint > 0.0 && !transient.controller;
  options.checkpoint_steps =
      has_checkpoints ? std::max(1L, std::lround(transient.checkpoint / options.step)) : 0;
  return options;
}

}  // namespace

model::Turbine turbine_after(const TransientSetup& transient, model::Turbine turbine,
                             const std::vector<double>& fired) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < fired.size(); ++i)
    if (std::isfinite(fired[i])) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&fired](std::size_t i) { return fired[i]; });
  for (const std::size_t i : order)
    turbine = turbine::apply_event(turbine, transient.events[i], fired[i]);
  return turbine;
}

ChannelWatch::ChannelWatch(const TransientSetup& transient, TransientOutput& output,
                           ControlLoop* loop)
    : transient_(transient),
      output_(output),
      loop_(loop),
      steps_(std::lround(transient.options.duration / transient.options.step)) {}

void ChannelWatch::begin_leg(const turbine::TurbineSystem& system,
                             const std::vector<std::size_t>& watched, const TransientState& state) {
  state_ = state;
  channels_.emplace(system, transient_);
  values_.resize(channels_->channels().size());
  ranges_.resize(values_.size());
  watched_ = watched;
  watch_.reset();
  crossing_.reset();
  has_level_ = false;
  std::vector<std::string> names;
  for (const std::size_t i : watched) names.push_back(transient_.events[i].trigger.channel);
  levels_.resize(names.size());
  if (!names.empty()) watch_.emplace(system, transient_.stations, names);
  if (loop_ != nullptr) loop_->begin_leg(system, state.point);
}

bool ChannelWatch::sample(const analysis::TransientSample& sample) {
  if (find_crossing(sample)) return false;
  take_row(sample);
  if (loop_ != nullptr) loop_->sample(sample);
  output_.progress("transient", sample.step, steps_);
  return output_.goes_on();
}

void ChannelWatch::checkpoint(const analysis::TransientStart& point) {
  state_.point = point;
  output_.checkpoint(state_);
}

void ChannelWatch::take_row(const analysis::TransientSample& sample) {
  const bool is_new = !last_row_ || sample.t > *last_row_;  // an event may restart the run
  if (!is_new || !sample.on_grid || sample.step % transient_.output_steps != 0) return;
  last_row_ = sample.t;
  channels_->evaluate(sample.t, sample.z, sample.z_dot, values_);
  output_.row(sample.t, values_);
  for (std::size_t i = 0; i < values_.size(); ++i) ranges_[i].add(values_[i]);
}

/// Finds the first of the watched events whose condition is met now.
bool ChannelWatch::find_crossing(const analysis::TransientSample& sample) {
  if (!watch_) return false;
  std::vector<double> now(levels_.size());
  watch_->evaluate(sample.t, sample.z, sample.z_dot, now);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const turbine::EventTrigger& trigger = transient_.events[watched_[i]].trigger;
    if (!trigger.holds(now[i])) continue;
    double time = sample.t;
    if (has_level_ && now[i] != levels_[i])
      time = time_ + (sample.t - time_) * (trigger.level - levels_[i]) / (now[i] - levels_[i]);
    if (!crossing_ || time < crossing_->time) crossing_ = {watched_[i], time};
  }
  if (crossing_) return true;
  levels_ = now;
  time_ = sample.t;
  has_level_ = true;
  return false;
}

TransientLegs::TransientLegs(const TransientSetup& transient,
                             std::shared_ptr<const turbine::TurbineSystem> begun,
                             const model::Turbine& turbine, TransientState state, int generator,
                             TransientOutput& output, ControlLoop* loop, MPI_Comm comm)
    : transient_(transient),
      options_(options_of(transient)),
      turbine_(turbine_after(transient, turbine, state.events)),
      state_(std::move(state)),
      generator_(generator),
      loop_(loop),
      comm_(comm),
      watch_(transient, output, loop) {
  const bool is_begun = loop == nullptr && std::ranges::none_of(state_.events, [](double time) {
                          return std::isfinite(time);
                        });
  if (is_begun) system_ = std::move(begun);
}

TransientSummary TransientLegs::run() {
  TransientSummary summary;
  summary.began = state_.point.time;
  while (true) {
    const std::optional<double> stop = next_time();
    if (stop && *stop <= state_.point.time) {
      fire_at(*stop);
      continue;
    }
    const analysis::TransientRun leg = run_leg(stop, to_watch());
    if (watch_.crossing()) {
      pass(*watch_.crossing(), leg);
      continue;
    }
    state_.point = leg.end;
    if (leg.reason == analysis::TransientEnd::stopped) {
      fire_at(*stop);
      continue;
    }
    if (loop_ != nullptr) loop_->end();
    total_.end = leg.end;
    total_.reason = leg.reason;
    summary.run = total_;
    summary.end = state_;
    summary.ranges = watch_.ranges();
    return summary;
  }
}

void TransientLegs::fire_at(double time) {
  for (std::size_t i = 0; i < state_.events.size(); ++i)
    if (const std::optional<double>& at = transient_.events[i].trigger.time;
        !std::isfinite(state_.events[i]) && at && on_grid(*at) == time)
      fire(i);
}

/// The time of an event, or the nearest instant of the grid if it is close.
double TransientLegs::on_grid(double time) const {
  const double origin = state_.point.origin;
  const double nearest = origin + std::round((time - origin) / options_.step) * options_.step;
  return std::abs(time - nearest) < closest_event * options_.step ? nearest : time;
}

analysis::TransientRun TransientLegs::run_leg(std::optional<double> stop,
                                              const std::vector<std::size_t>& watch) {
  if (!system_) system_ = std::make_shared<const turbine::TurbineSystem>(turbine_, PETSC_COMM_SELF);
  watch_.begin_leg(*system_, watch, state_);
  analysis::TransientOptions options = options_;
  options.stop_at = stop;
  analysis::TransientRun leg =
      analysis::run_transient(*system_, state_.point, options, watch_, comm_);
  total_.method = leg.method;
  total_.ranks = leg.ranks;
  total_.steps += leg.steps;
  total_.newton_steps += leg.newton_steps;
  total_.factorizations += leg.factorizations;
  total_.cuts += leg.cuts;
  return leg;
}

/// Advances from the step before a state event to the time of the event.
void TransientLegs::pass(Crossing crossing, const analysis::TransientRun& leg) {
  const double time = std::min(on_grid(crossing.time), leg.end.time);
  if (leg.steps > 0) state_.point = leg.before;
  if (leg.steps > 0 && time > state_.point.time) state_.point = run_leg(time, {}).end;
  fire(crossing.event);
}

void TransientLegs::fire(std::size_t i) {
  const turbine::TurbineEvent& event = transient_.events[i];
  state_.events[i] = state_.point.time;
  turbine_ = turbine::apply_event(turbine_, event, state_.point.time);
  system_.reset();
  if (!event.generator_off) return;
  for (analysis::HeldCoordinate& held : state_.point.held)
    if (held.unknown == generator_) held.load = 0.0;
}

std::optional<double> TransientLegs::next_time() const {
  std::optional<double> next;
  for (std::size_t i = 0; i < state_.events.size(); ++i) {
    const std::optional<double>& time = transient_.events[i].trigger.time;
    if (!std::isfinite(state_.events[i]) && time && (!next || on_grid(*time) < *next))
      next = on_grid(*time);
  }
  return next;
}

std::vector<std::size_t> TransientLegs::to_watch() const {
  std::vector<std::size_t> watched;
  for (std::size_t i = 0; i < state_.events.size(); ++i)
    if (!std::isfinite(state_.events[i]) && !transient_.events[i].trigger.time)
      watched.push_back(i);
  return watched;
}

}  // namespace samara::simulation
