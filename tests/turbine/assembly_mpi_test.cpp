// The assembly on any number of ranks against the serial one. Every rank builds both; what differs
// is reduced before it is judged, so that no rank waits for another that has failed.
#include <vector>

#include <boost/test/unit_test.hpp>

#include "sample_turbine.hpp"

namespace {

using namespace samara;

/// Every rank does the serial arithmetic; only the places of the numbers differ.
constexpr double same = 0.0;

/// Sums of a row may be taken in another order where a product is spread over ranks.
constexpr double order_of_sums = 1e-13;

/// Odd and even numbers of blocks, with and without a tower: ranks own unlike shares.
std::vector<sample::Choice> some_choices() {
  const std::vector<sample::Choice> all = sample::choices();
  return {all[0], all[2], all[6], all[7]};
}

double largest_on_all_ranks(double mine) {
  double largest = 0.0;
  MPI_Allreduce(&mine, &largest, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  return largest;
}

int sum_on_all_ranks(int mine) {
  int sum = 0;
  MPI_Allreduce(&mine, &sum, 1, MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
  return sum;
}

/// Largest difference in the rows that this rank owns.
struct OwnRows {
  PetscInt first = 0;
  PetscInt count = 0;

  double difference(const Eigen::MatrixXd& mine, const Eigen::MatrixXd& whole) const {
    if (count == 0) return 0.0;
    return (mine.middleRows(first, count) - whole.middleRows(first, count)).cwiseAbs().maxCoeff();
  }
};

OwnRows own_rows(Vec vector) {
  PetscInt first = 0;
  PetscInt last = 0;
  petsc::check(VecGetOwnershipRange(vector, &first, &last));
  return {first, last - first};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(assembly)

BOOST_AUTO_TEST_CASE(each_row_is_written_by_one_rank) {
  for (const sample::Choice& choice : some_choices()) {
    const model::Turbine turbine = model::build_turbine(sample::turbine_definition(choice));
    const turbine::TurbineSystem shared(turbine, PETSC_COMM_WORLD);
    const petsc::Handle<Vec> z = shared.make_state();
    const int rows = sum_on_all_ranks(static_cast<int>(own_rows(z.get()).count));
    BOOST_TEST(rows == shared.size());
  }
}

BOOST_AUTO_TEST_CASE(residual_and_reference_state_are_the_serial_ones) {
  for (const sample::Choice& choice : some_choices()) {
    const model::Turbine turbine = model::build_turbine(sample::turbine_definition(choice));
    const turbine::TurbineSystem shared(turbine, PETSC_COMM_WORLD);
    const turbine::TurbineSystem serial(turbine, PETSC_COMM_SELF);
    const OwnRows own = own_rows(shared.make_state().get());
    for (unsigned seed = 1; seed <= 2; ++seed) {
      const sample::RandomState state = sample::random_state(serial, seed);
      const double difference =
          own.difference(sample::residual_of(shared, 0.3, state.z, state.z_dot),
                         sample::residual_of(serial, 0.3, state.z, state.z_dot));
      BOOST_TEST(largest_on_all_ranks(difference) <= same);
    }
    const double reference = own.difference(sample::reference_state_of(shared, 0.3),
                                            sample::reference_state_of(serial, 0.3));
    BOOST_TEST(largest_on_all_ranks(reference) <= same);
  }
}

BOOST_AUTO_TEST_CASE(tangents_are_the_serial_ones) {
  constexpr double shift = 7.0;
  for (const sample::Choice& choice : some_choices()) {
    const model::Turbine turbine = model::build_turbine(sample::turbine_definition(choice));
    const turbine::TurbineSystem shared(turbine, PETSC_COMM_WORLD);
    const turbine::TurbineSystem serial(turbine, PETSC_COMM_SELF);
    const OwnRows own = own_rows(shared.make_state().get());
    const petsc::Handle<Mat> J = shared.make_jacobian();
    const petsc::Handle<Mat> M = shared.make_mass();
    // Twice into the same matrices: nothing of the first state may remain.
    for (unsigned seed = 1; seed <= 2; ++seed) {
      const sample::RandomState state = sample::random_state(serial, seed);
      const sample::Tangents expected = sample::tangents_of(serial, 0.3, state.z, state.z_dot);
      const petsc::Handle<Vec> z = sample::to_petsc(shared, state.z);
      const petsc::Handle<Vec> z_dot = sample::to_petsc(shared, state.z_dot);
      shared.tangents(0.3, z.get(), z_dot.get(), shift, J.get(), M.get());
      const double mass = own.difference(sample::to_dense(M.get()), expected.M);
      BOOST_TEST(largest_on_all_ranks(mass) <= same);
      const Eigen::MatrixXd K_shifted = expected.K + shift * expected.M;
      const double scale = K_shifted.cwiseAbs().maxCoeff();
      const double jacobian = own.difference(sample::to_dense(J.get()), K_shifted);
      BOOST_TEST(largest_on_all_ranks(jacobian) <= order_of_sums * scale);

      const petsc::Handle<Vec> product = shared.make_state();
      petsc::check(MatMult(J.get(), z.get(), product.get()));
      const Eigen::VectorXd by_hand = K_shifted * state.z;
      const double product_error = own.difference(sample::to_dense(product.get()), by_hand);
      BOOST_TEST(largest_on_all_ranks(product_error) <=
                 order_of_sums * by_hand.cwiseAbs().maxCoeff());
    }
  }
}

BOOST_AUTO_TEST_CASE(the_rates_of_a_state_may_be_the_only_thing_that_differs) {
  // The gathered copies of z and z_dot must not be mixed up.
  const model::Turbine turbine = model::build_turbine(sample::turbine_definition({}));
  const turbine::TurbineSystem shared(turbine, PETSC_COMM_WORLD);
  const turbine::TurbineSystem serial(turbine, PETSC_COMM_SELF);
  const sample::RandomState state = sample::random_state(serial, 3);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(serial.size());
  const OwnRows own = own_rows(shared.make_state().get());
  const double by_rates = own.difference(sample::residual_of(shared, 0.0, zero, state.z_dot),
                                         sample::residual_of(serial, 0.0, zero, state.z_dot));
  const double by_state = own.difference(sample::residual_of(shared, 0.0, state.z, zero),
                                         sample::residual_of(serial, 0.0, state.z, zero));
  BOOST_TEST(largest_on_all_ranks(by_rates) <= same);
  BOOST_TEST(largest_on_all_ranks(by_state) <= same);
}

BOOST_AUTO_TEST_SUITE_END()
