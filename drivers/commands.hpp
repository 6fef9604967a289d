// The sub-commands, one file each.
#pragma once

#include "command_line.hpp"
#include "job.hpp"

namespace samara::drivers {

void run_check(const Job& job);
void run_modes(const Job& job);
void run_trim(const Job& job);
void run_floquet(const Job& job);

void run_import(const CommandLine& line);

/// Floquet's theory needs a period.
void require_speed(const io::Case& input);

}  // namespace samara::drivers
