// A simulation in time of a mesh that is distributed over ranks: every rank also integrates it
// alone.
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/analysis/transient.hpp"
#include "samara/base/error.hpp"
#include "samara/petsc/handle.hpp"
#include "samara/turbine/turbine_system.hpp"

#include "distributed.hpp"

using namespace samara;
using namespace samara::test;
using analysis::TransientOptions;
using analysis::TransientRun;
using analysis::TransientStart;

namespace {

/// Relative to the largest value of the same quantity. A step ends with an error of 1e-9.
constexpr double same = 1e-7;

/// Keeps the samples, and a checkpoint.
class Keeper : public analysis::TransientObserver {
 public:
  explicit Keeper(long last = 1000) : last_(last) {}
  bool sample(const analysis::TransientSample& sample) override {
    times.push_back(sample.t);
    states.push_back(values_of(sample.z));
    rates.push_back(values_of(sample.z_dot));
    return sample.step < last_;
  }
  void checkpoint(const TransientStart& point) override { kept = point; }

  std::vector<double> times;
  std::vector<Eigen::VectorXd> states;
  std::vector<Eigen::VectorXd> rates;
  std::optional<TransientStart> kept;

 private:
  static Eigen::VectorXd values_of(Vec vector) {
    const std::vector<double> values = petsc::values_of(vector);
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
  }
  long last_;
};

TransientOptions steps_of(double step, int count) {
  TransientOptions options;
  options.step = step;
  options.duration = step * count;
  return options;
}

void require_same(const system::PeriodicSystem& system, const Eigen::VectorXd& a,
                  const Eigen::VectorXd& b) {
  for (const system::UnknownRole role :
       {system::UnknownRole::position, system::UnknownRole::velocity,
        system::UnknownRole::internal})
    BOOST_TEST(on_all_ranks(difference(system, a, b, role) < same));
}

turbine::TurbineSystem system_of(const model::TurbineDefinition& definition) {
  return {model::build_turbine(definition), PETSC_COMM_SELF};
}

void require_same_run(const turbine::TurbineSystem& system, const TransientStart& start,
                      const TransientOptions& options, bool is_distributed) {
  Keeper alone;
  Keeper together;
  const TransientRun one = analysis::run_transient(system, start, options, alone);
  BOOST_TEST(on_all_ranks(one.ranks == 1));
  const TransientRun all =
      analysis::run_transient(system, start, options, together, PETSC_COMM_WORLD);
  const int expected = is_distributed ? ranks() : 1;
  BOOST_TEST(on_all_ranks(all.ranks == expected));
  BOOST_TEST(on_all_ranks(all.steps == one.steps));
  BOOST_TEST_REQUIRE(on_all_ranks(together.times == alone.times));
  BOOST_TEST_REQUIRE(alone.times.size() > 2U);
  for (std::size_t i = 0; i < alone.times.size(); ++i) {
    require_same(system, alone.states[i], together.states[i]);
    if (i > 0)
      BOOST_TEST(on_all_ranks(difference(system, alone.rates[i], together.rates[i],
                                         system::UnknownRole::position) < same));
  }
  require_same(system, one.end.z, all.end.z);
  require_same(system, one.before.z, all.before.z);
  // Every rank has the same state, bit by bit.
  Eigen::VectorXd first = all.end.z;
  MPI_Bcast(first.data(), static_cast<int>(first.size()), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  BOOST_TEST(on_all_ranks(first == all.end.z));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(transient)

// Loads that hold the free yaw and the mean speed continue from the steady state.
BOOST_AUTO_TEST_CASE(a_distributed_turbine_moves_as_on_one_rank) {
  const auto system = system_of(lee_turbine({120, 1, 200, 1}, 9.81));
  analysis::TrimOptions options;
  options.automatic = false;
  options.harmonics = 2;
  analysis::Observer observer;
  const analysis::Trim trim = analysis::find_trim(system, options, observer);
  TransientStart start = analysis::start_on(system, trim, 0.0);
  BOOST_TEST_REQUIRE(!start.held.empty());
  // A push out of the steady state.
  for (analysis::HeldCoordinate& held : start.held) held.load += 1e-3 * trim.load_level;
  require_same_run(system, start, steps_of(0.01, 8), ranks() > 1);
}

// Rates at the start are not known; some ranks have no piece: 3 ranks, and chains of 250 nodes.
BOOST_AUTO_TEST_CASE(a_distributed_start_without_strain) {
  const auto system = system_of(single_blade(250));
  require_same_run(system, analysis::start_undeformed(system, 0.0), steps_of(2e-3, 10),
                   ranks() > 1);
}

BOOST_AUTO_TEST_CASE(elements_of_high_order_and_adaptive_steps) {
  const auto system = system_of(lee_turbine({20, 4, 30, 5}, 9.81));
  TransientOptions options = steps_of(5e-3, 6);
  options.step_tolerance = 1e-5;
  require_same_run(system, analysis::start_undeformed(system, 0.0), options, ranks() > 1);
}

BOOST_AUTO_TEST_CASE(small_meshes_and_the_midpoint_rule_stay_on_one_rank) {
  const auto small = system_of(lee_turbine({4, 1, 6, 2}, 9.81));
  require_same_run(small, analysis::start_undeformed(small, 0.0), steps_of(0.01, 4), false);
  const auto large = system_of(single_blade(250));
  TransientOptions options = steps_of(2e-3, 4);
  options.method = analysis::TransientMethod::midpoint;
  BOOST_TEST(!analysis::is_distributed(large, options, PETSC_COMM_WORLD));
  require_same_run(large, analysis::start_undeformed(large, 0.0), options, false);
}

// A checkpoint of several ranks continues on one, and the other way round.
BOOST_AUTO_TEST_CASE(a_run_continues_with_another_number_of_ranks) {
  const auto system = system_of(single_blade(250));
  TransientOptions options = steps_of(2e-3, 12);
  options.checkpoint_steps = 6;
  const TransientStart start = analysis::start_undeformed(system, 0.0);
  Keeper whole;
  const TransientRun direct =
      analysis::run_transient(system, start, options, whole, PETSC_COMM_WORLD);
  BOOST_TEST_REQUIRE(whole.kept.has_value());
  Keeper rest;
  require_same(system, direct.end.z,
               analysis::run_transient(system, *whole.kept, options, rest).end.z);
  Keeper alone;
  analysis::run_transient(system, start, options, alone);
  require_same(system, direct.end.z,
               analysis::run_transient(system, *alone.kept, options, rest, PETSC_COMM_WORLD).end.z);
}

// The observer of one rank ends the run of all, or fails.
BOOST_AUTO_TEST_CASE(an_observer_of_one_rank_ends_all) {
  const auto system = system_of(single_blade(250));
  const TransientStart start = analysis::start_undeformed(system, 0.0);
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  Keeper keeper(rank == ranks() - 1 ? 3 : 1000);
  const TransientRun run =
      analysis::run_transient(system, start, steps_of(2e-3, 10), keeper, PETSC_COMM_WORLD);
  BOOST_TEST(on_all_ranks(run.reason == analysis::TransientEnd::observer));
  BOOST_TEST(on_all_ranks(std::abs(run.end.time - 6e-3) < 1e-12));

  class Failing : public Keeper {
   public:
    explicit Failing(bool fails) : fails_(fails) {}
    bool sample(const analysis::TransientSample& sample) override {
      if (fails_ && sample.step == 2) throw InputError("no space left");
      return Keeper::sample(sample);
    }

   private:
    bool fails_;
  };
  Failing failing(rank == ranks() - 1);
  bool has_failed = false;
  try {
    analysis::run_transient(system, start, steps_of(2e-3, 10), failing, PETSC_COMM_WORLD);
  } catch (const InputError& error) {
    has_failed = std::string(error.what()) == "no space left";
  }
  BOOST_TEST(on_all_ranks(has_failed));
}

// The blade bends by more than a step allows: each rank has the same error, with the place.
BOOST_AUTO_TEST_CASE(a_step_that_fails_on_one_rank_fails_on_all) {
  model::TurbineDefinition definition = single_blade(220);
  definition.shaft.speed = 0.1;
  definition.blades.beam.sections = {stiff_section(1e2)};
  const auto system = system_of(definition);
  Keeper keeper;
  std::string text;
  try {
    analysis::run_transient(system, analysis::start_undeformed(system, 0.0), steps_of(0.5, 10),
                            keeper, PETSC_COMM_WORLD);
  } catch (const std::exception& error) {
    text = error.what();
  }
  BOOST_TEST(on_all_ranks(text.find("transient: no step from t =") != std::string::npos));
  std::vector<char> first(text.begin(), text.end());
  MPI_Bcast(first.data(), static_cast<int>(first.size()), MPI_CHAR, 0, PETSC_COMM_WORLD);
  BOOST_TEST(on_all_ranks(std::string(first.begin(), first.end()) == text));
}

BOOST_AUTO_TEST_SUITE_END()
