#include "mode_sharing.hpp"

#include <cstddef>
#include <vector>

namespace samara::analysis {
namespace {

void share_owner(const Ranks& ranks, int source, std::optional<system::Owner>& owner) {
  bool is_given = owner.has_value();
  ranks.share(source, is_given);
  if (!is_given) {
    owner.reset();
    return;
  }
  if (!owner) owner.emplace();
  ranks.share(source, owner->kind);
  ranks.share(source, owner->part);
  ranks.share(source, owner->instance);
}

}  // namespace

void share_mode(const Ranks& ranks, int source, Mode& mode) {
  if (ranks.size == 1) return;
  for (std::complex<double>* value : {&mode.multiplier, &mode.exponent, &mode.step_exponent})
    ranks.share(source, *value);
  for (double* value : {&mode.damping_ratio, &mode.fixed_frame_frequency, &mode.step_error,
                        &mode.mesh_error, &mode.round_off_error, &mode.growth_error,
                        &mode.mesh_growth_error, &mode.residual, &mode.kinetic_energy})
    ranks.share(source, *value);
  for (int* value : {&mode.harmonic, &mode.shape_number, &mode.number}) ranks.share(source, *value);
  for (bool* value : {&mode.is_mixture, &mode.resolved}) ranks.share(source, *value);
  for (std::string* text : {&mode.name, &mode.motion, &mode.label}) ranks.share(source, *text);
  std::size_t parts = mode.parts.size();
  ranks.share(source, parts);
  mode.parts.resize(parts);
  for (PartShare& part : mode.parts) {
    ranks.share(source, part.part);
    ranks.share(source, part.share);
  }
  share_owner(ranks, source, mode.state);
}

void share_modes(const Ranks& ranks, ModeSet& set) {
  if (ranks.size == 1) return;
  std::size_t count = set.modes.size();
  ranks.share(0, count);
  set.modes.resize(count);
  for (Mode& mode : set.modes) share_mode(ranks, 0, mode);
  for (int* value : {&set.degrees_of_freedom, &set.instances, &set.states, &set.found,
                     &set.medium_states, &set.deflated, &set.first_harmonic})
    ranks.share(0, *value);
  for (double* value : {&set.rotor_speed, &set.step, &set.deflated_rate, &set.reach})
    ranks.share(0, *value);
  ranks.share(0, set.conservative);
  bool is_searched = set.searched.has_value();
  ranks.share(0, is_searched);
  if (is_searched) {
    if (!set.searched) set.searched.emplace();
    ranks.share(0, *set.searched);
  }
  ranks.share(0, set.participation);
  ranks.share(0, set.shape_times);
}

}  // namespace samara::analysis
