#include "samara/math/dependence.hpp"

#include <limits>

#include <boost/test/unit_test.hpp>

#include "samara/math/rotation.hpp"
#include "samara/math/types.hpp"

using samara::Mat3;
using samara::Vec3;
using samara::math::Dependence;

BOOST_AUTO_TEST_SUITE(dependence)

BOOST_AUTO_TEST_CASE(sums_and_products_depend_on_all_that_is_in_them) {
  const Dependence a = Dependence::on(0);
  const Dependence b = Dependence::on(63);
  for (const Dependence& value : {a + b, a - b, a * b, a / b, sin(a) * cos(b), sqrt(a * b)}) {
    BOOST_TEST(value.is_on(0));
    BOOST_TEST(value.is_on(63));
    BOOST_TEST(!value.is_on(1));
  }
  BOOST_TEST((-a + 3.0).quantities() == a.quantities());
}

BOOST_AUTO_TEST_CASE(zero_takes_away_what_it_multiplies) {
  const Dependence a = Dependence::on(2);
  const Dependence zero = Dependence(2.0) * 0.5 - 1.0;
  BOOST_TEST(zero.is_zero());
  for (const Dependence& value : {zero * a, a * zero, zero / a, sin(zero) * a}) {
    BOOST_TEST(value.is_zero());
    BOOST_TEST(value.quantities() == 0U);
  }
  BOOST_TEST((cos(zero) * a).is_on(2));
}

BOOST_AUTO_TEST_CASE(what_varies_is_no_zero) {
  const Dependence varying(std::numeric_limits<double>::quiet_NaN());
  BOOST_TEST(!varying.is_zero());
  BOOST_TEST(!(varying - varying).is_zero());
  BOOST_TEST((varying * Dependence::on(1)).is_on(1));
  BOOST_TEST((varying * 0.0).is_zero());
}

BOOST_AUTO_TEST_CASE(rotation_about_an_axis_leaves_it_alone) {
  const Mat3<Dependence> turn =
      samara::math::turn_about<Dependence>(samara::Vector3::UnitZ(), Dependence::on(0));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) BOOST_TEST(turn(i, j).is_zero() == ((i == 2) != (j == 2)));
  BOOST_TEST(turn(0, 1).is_on(0));
}

BOOST_AUTO_TEST_CASE(matrices_of_it_multiply) {
  const Mat3<Dependence> unit = samara::Matrix3::Identity().cast<Dependence>();
  Vec3<Dependence> v;
  for (int i = 0; i < 3; ++i) v(i) = Dependence::on(i);
  const Vec3<Dependence> same = unit * v;
  for (int i = 0; i < 3; ++i) BOOST_TEST(same(i).quantities() == v(i).quantities());
}

BOOST_AUTO_TEST_SUITE_END()
