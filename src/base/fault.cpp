#include "samara/base/fault.hpp"

#include "samara/base/error.hpp"

namespace samara {

bool is_within(const std::string& field, const std::string& outer) {
  return field.starts_with(outer) && (field.size() == outer.size() || outer.empty() ||
                                      field[outer.size()] == '.' || field[outer.size()] == '[');
}

void require_none(const std::vector<Fault>& faults, const std::string& source) {
  std::string text;
  for (const Fault& fault : faults) {
    if (!text.empty()) text += "\n";
    if (!source.empty()) text += source + ": ";
    if (!fault.field.empty()) text += fault.field + ": ";
    text += fault.text;
  }
  if (!text.empty()) throw InputError(text);
}

}  // namespace samara
