// Evaluated loads as tables.
#pragma once

#include <string>
#include <vector>

#include "samara/io/load_result.hpp"

namespace samara::drivers {

/// Statistics, equivalent loads, extreme events, harmonics and rainflow counts of one result.
std::string load_tables(const io::LoadReport& report, const io::LoadOptions& options);

/// Equivalent loads of all results together.
std::string lifetime_table(const std::vector<io::LoadReport>& reports,
                           const io::LifetimeReport& lifetime, const io::LoadOptions& options);

}  // namespace samara::drivers
