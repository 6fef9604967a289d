// What a change of numbers of the case does to the modes, for --sensitivity.
#pragma once

#include <string>
#include <vector>

#include "samara/analysis/mode.hpp"
#include "samara/io/result_file.hpp"
#include "samara/simulation/sensitivity.hpp"
#include "samara/simulation/stability.hpp"

#include "job.hpp"

namespace samara::drivers {

/// The numbers that a pattern of --sensitivity names.
struct ParameterGroup {
  std::string pattern;
  std::vector<simulation::Parameter> parameters;
};

/// Patterns are separated by commas. @throws InputError
std::vector<ParameterGroup> find_parameters(const Job& job);

/// The sensitivities of the listed modes, by group.
struct Sensitivities {
  std::vector<ParameterGroup> groups;
  std::vector<std::size_t> modes;  ///< numbers in the set
  std::vector<std::vector<simulation::Sensitivity>> found;
};

/// One table for each group: the change of frequency and damping where all its numbers grow by 1 %,
/// and the number with the largest part; of numbers that are all 0, per unit.
std::string sensitivity_tables(const analysis::ModeSet& set, const Sensitivities& sensitivities);

/// /floquet/sensitivity.
void write_sensitivities(io::ResultFile& file, const analysis::ModeSet& set,
                         const Sensitivities& sensitivities);

}  // namespace samara::drivers
