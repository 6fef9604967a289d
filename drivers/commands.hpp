// The sub-commands; each has a file of its own.
#pragma once

#include <string>
#include <vector>

#include "samara/turbine/turbine_input_output.hpp"

#include "command_line.hpp"
#include "job.hpp"

namespace samara::drivers {

void run_check(const Job& job);
void run_static(const Job& job);
void run_modes(const Job& job);
void run_trim(const Job& job);
void run_floquet(const Job& job);
void run_transient(const Job& job);
void run_loads(const Job& job);
void run_linearize(const Job& job);
void run_operate(const Job& job);
void run_campbell(const Job& job);

/// These replace the process by the Python package's command line. @throws InputError if they
/// cannot
void run_plot(const std::vector<std::string>& arguments);
void run_report(const std::vector<std::string>& arguments);
void run_vtk(const std::vector<std::string>& arguments);

/// True for arguments of samara export that run_vtk takes: --format, or a name that ends in .pvd.
bool asks_for_vtk(const std::vector<std::string>& arguments);

void run_new(const std::vector<std::string>& arguments);

void run_import(const CommandLine& line);
void run_export(const CommandLine& line);

/// The inputs and outputs of the linear model. @throws InputError for an unknown name
turbine::TurbineInputOutput make_input_output(const io::Case& input,
                                              const turbine::TurbineSystem& system);

}  // namespace samara::drivers
