// Deflections and internal loads along the beams, compared with the channels of the same places.
#include "samara/turbine/beam_stations.hpp"

#include <numbers>
#include <string>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "samara/turbine/turbine_channels.hpp"

#include "sample_turbine.hpp"

using namespace samara;
using turbine::BeamStation;

namespace {

/// Of values of order one after some ten operations, in units up to 1e3 times smaller.
constexpr double round_off = 1e-11;
constexpr double degree = std::numbers::pi / 180.0;

/// b1 b2 b3 from the axes x y z of the channels.
Vector3 of_channels(const Vector3& v) { return {v(2), -v(1), v(0)}; }

class Channels {
 public:
  Channels(const turbine::TurbineSystem& system, double t, const std::vector<double>& z,
           const std::vector<double>& z_dot)
      : system_(system), t_(t), z_(z), z_dot_(z_dot) {}

  /// The vector of three channels: those of `before` with x, y, z between it and `after`.
  Vector3 vector(const std::string& before, const std::string& after) const {
    const turbine::TurbineChannels channels(
        system_, {}, {before + "x" + after, before + "y" + after, before + "z" + after});
    std::vector<double> values(3);
    channels.evaluate<double>(t_, z_, z_dot_, values);
    return of_channels(Vector3(values[0], values[1], values[2]));
  }

 private:
  const turbine::TurbineSystem& system_;
  double t_;
  const std::vector<double>& z_;
  const std::vector<double>& z_dot_;
};

/// Turned by a rotation vector.
Vector3 turned(const Vector3& rotation, const Vector3& v) {
  return rotation.isZero(0.0)
             ? v
             : Vector3(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()) * v);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(beam_stations)

BOOST_AUTO_TEST_CASE(stations_have_the_loads_and_deflections_of_the_channels_in_axes_of_the_root) {
  constexpr double t = 0.4;
  for (const sample::Choice& choice : sample::choices()) {
    const turbine::TurbineSystem system(model::build_turbine(sample::turbine_definition(choice)),
                                        PETSC_COMM_SELF);
    const sample::RandomState state = sample::random_state(system, 5);
    const std::vector<double> z(state.z.begin(), state.z.end());
    const std::vector<double> z_dot(state.z_dot.begin(), state.z_dot.end());
    const auto beams = turbine::find_beam_stations(system, t, z, z_dot);
    const Channels channels(system, t, z, z_dot);
    const model::Turbine& turbine = system.turbine();
    BOOST_REQUIRE(beams.size() == turbine.blades.size() + (choice.tower ? 1 : 0));
    for (std::size_t b = 0; b < beams.size(); ++b) {
      const bool is_blade = b < turbine.blades.size();
      const model::Beam& beam = is_blade ? turbine.blades[b] : turbine.tower;
      const std::string number = std::to_string(b + 1);
      const std::string after = is_blade ? "" : "t";
      BOOST_REQUIRE(static_cast<int>(beams[b].size()) == beam.point_count() + 2);
      BOOST_TEST(beams[b].size() == turbine::station_fractions(beam).size());
      for (int p = 0; p < beam.point_count(); ++p) {
        const BeamStation& station = beams[b][static_cast<std::size_t>(p) + 1];
        const std::string place = std::to_string(p + 1);
        const std::string before = is_blade ? "B" + number + "N" + place : "TwHt" + place;
        const Vector3 rotation = degree * channels.vector(before + "RD", after);
        const Matrix3& section = beam.points[static_cast<std::size_t>(p)].C_ab;
        const Vector3 force = section * channels.vector(before + "FL", after) * 1e3;
        const Vector3 moment = section * channels.vector(before + "ML", after) * 1e3;
        const double size = force.norm() + moment.norm();
        BOOST_TEST((station.displacement - channels.vector(before + "TD", after)).norm() <
                   round_off);
        BOOST_TEST((station.rotation - rotation).norm() < round_off);
        BOOST_TEST((station.force - turned(rotation, force)).norm() < round_off * size);
        BOOST_TEST((station.moment - turned(rotation, moment)).norm() < round_off * size);
      }
      const std::string force = is_blade ? "RootF" : "TwrBsF";
      const std::string moment = is_blade ? "RootM" : "TwrBsM";
      const std::string axes = is_blade ? "b" + number : "t";
      const BeamStation& root = beams[b].front();
      BOOST_TEST((root.force - 1e3 * channels.vector(force, axes)).norm() <
                 round_off * (1.0 + root.force.norm()));
      BOOST_TEST((root.moment - 1e3 * channels.vector(moment, axes)).norm() <
                 round_off * (1.0 + root.moment.norm()));
      BOOST_TEST(root.displacement.isZero(0.0));
      const BeamStation& end = beams[b].back();
      const Vector3 moved =
          is_blade ? channels.vector("TipD", "b" + number) : channels.vector("YawBrTD", "t");
      const Vector3 rotated =
          is_blade ? channels.vector("TipRD", "b" + number) : channels.vector("YawBrRD", "t");
      BOOST_TEST((end.displacement - moved).norm() < round_off);
      BOOST_TEST((end.rotation - degree * rotated).norm() < round_off);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
