// All requested forms of the linear model (docs/theory.md, section 10).
#pragma once

#include <string>
#include <vector>

#include "samara/analysis/observer.hpp"
#include "samara/linear/azimuth_series.hpp"
#include "samara/linear/linear_model.hpp"
#include "samara/linear/lyapunov_floquet.hpp"
#include "samara/linear/model_reduction.hpp"

namespace samara::linear {

struct LinearizeOptions {
  SeriesResolution series = {};  ///< of the equally spaced azimuths and of the harmonics
  bool descriptor = false;
  bool state_space = true;
  bool multiblade = false;
  bool average =
      false;  ///< mean over the azimuth, of multiblade coordinates where these are requested
  bool hill = false;
  int hill_harmonics = 4;
  bool lyapunov_floquet = false;
  int lyapunov_floquet_steps = LyapunovFloquet::default_steps;  ///< in a revolution, at least
  int lyapunov_floquet_states = 0;  ///< of the slowest modes; 0: all that are resolved
  std::vector<double> at;           ///< azimuths at which matrices are given [rad]; none: all
  int order = 0;                    ///< of reduced constant forms; 0: none
  ReductionMethod reduction = ReductionMethod::balanced;
};

/// A form with the names of its states, inputs and outputs. If the series has one coefficient, the
/// form does not change with the azimuth.
struct NamedForm {
  std::string name;  ///< "state_space"
  std::string description;
  std::vector<ModelState> states;
  std::vector<system::Signal> inputs, outputs;
  AzimuthSeries series;
  std::vector<StateSpace> at_azimuths = {};  ///< the matrices themselves, where they change
  Eigen::VectorXd hankel = {};               ///< of a reduced form, see ReducedForm
  double error_bound = 0.0;
};

struct Linearization {
  std::vector<NamedForm> forms;
  std::vector<double> azimuths;             ///< at which matrices are given [rad]
  std::vector<DescriptorForm> descriptors;  ///< at the azimuths, if requested
  Eigen::MatrixXd outputs;                  ///< on the steady state, azimuths x outputs
  double rotor_speed = 0.0;                 ///< [rad/s]
  int series_azimuths = 0;                  ///< number of azimuths of the series
  bool is_constant = false;                 ///< nothing changes with the azimuth
};

/// `start_azimuth` [rad]: psi at t = 0. Serial: every rank computes the same.
/// @throws InputError where a form does not exist for the system
Linearization linearize(const system::PeriodicSystem& system,
                        const system::InputOutput& input_output,
                        const analysis::PeriodicSolution& solution, double start_azimuth,
                        const LinearizeOptions& options, analysis::Observer& observer);

}  // namespace samara::linear
