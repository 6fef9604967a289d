#include "samara/system/metadata.hpp"

#include <algorithm>

namespace samara::system {
namespace {

/// The non-empty words, separated by spaces.
std::string joined(std::initializer_list<std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) {
    if (word.empty()) continue;
    if (!text.empty()) text += ' ';
    text += word;
  }
  return text;
}

}  // namespace

bool has_medium(const std::vector<Unknown>& unknowns) {
  return std::ranges::any_of(unknowns, &Unknown::is_of_medium);
}

const char* word_of(UnknownRole role) {
  switch (role) {
    case UnknownRole::position:
      return "position";
    case UnknownRole::velocity:
      return "velocity";
    case UnknownRole::internal:
      return "internal";
    case UnknownRole::state:
      return "state";
    case UnknownRole::auxiliary:
      return "auxiliary";
  }
  return "";
}

const char* word_of(RowRole role) {
  switch (role) {
    case RowRole::constraint:
      return "constraint";
    case RowRole::kinematic:
      return "kinematic";
    case RowRole::balance:
      return "balance";
    case RowRole::evolution:
      return "evolution";
    case RowRole::definition:
      return "definition";
  }
  return "";
}

std::string Owner::name() const {
  return instance > 0 ? part + ' ' + std::to_string(instance) : part;
}

std::string Unknown::name() const { return joined({owner.name(), place, quantity}); }

std::string Unknown::family() const { return joined({place, quantity}); }

std::string Motion::name() const { return joined({owner.part, direction}); }

std::string motion_name(const EnergyGroup& group) {
  return joined({group.owner.part, group.direction});
}

}  // namespace samara::system
