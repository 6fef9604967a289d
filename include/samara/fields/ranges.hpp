// Numbers out of the ranges that their fields declare.
#pragma once

#include <functional>
#include <vector>

#include "samara/base/fault.hpp"
#include "samara/fields/visitor.hpp"

namespace samara::fields {

/// Faults by the path of the field; `declare` visits the definition in question.
std::vector<Fault> find_range_faults(const std::function<void(Visitor&)>& declare);

/// "blades" and "mass": "blades.mass".
std::string join_path(const std::string& where, std::string_view key);
std::string join_path(const std::string& where, std::size_t index);

}  // namespace samara::fields
