// Events of a turbine: protection and failures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "samara/model/turbine.hpp"

namespace samara::turbine {

/// Triggers at a time, or at the first instant at which a channel is beyond a level.
struct EventTrigger {
  std::optional<double> time;  ///< [s]
  std::string channel;         ///< name, as in turbine_channels.hpp
  bool above = true;           ///< false: below
  double level = 0.0;          ///< in the channel's unit

  bool holds(double value) const { return above ? value >= level : value <= level; }
};

/// Changes the pitch of blades, by half a cosine in time.
struct PitchAction {
  int blade = 0;      ///< from 1; 0: all blades
  double to = 0.0;    ///< [rad]
  double rate = 0.0;  ///< largest rate, > 0 [rad/s]
};

struct TurbineEvent {
  EventTrigger trigger;
  std::optional<PitchAction> pitch;
  bool generator_off = false;  ///< the generator has no torque from then on
  double brake = 0.0;          ///< torque of a brake on the generator, behind the gear [N m]
};

/// The turbine from the event at time t on.
model::Turbine apply_event(const model::Turbine& turbine, const TurbineEvent& event, double t);

}  // namespace samara::turbine
