#include "import_furling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "import_common.hpp"

namespace samara::decks {
namespace {

/// In ElastoDyn's axes of the nacelle: x downwind, y to the left, z up, from the tower top.
struct Body {
  double mass = 0.0;
  Vector3 center = Vector3::Zero();
  Matrix3 inertia = Matrix3::Zero();  ///< about the centre
};

/// The furl axis: turned from x to y by the skew and up by the tilt.
Vector3 axis_of(double skew_deg, double tilt_deg) {
  const double skew = skew_deg * std::numbers::pi / 180.0;
  const double tilt = tilt_deg * std::numbers::pi / 180.0;
  return {std::cos(skew) * std::cos(tilt), std::sin(skew) * std::cos(tilt), std::sin(tilt)};
}

/// Body that turns about a furl axis: ElastoDyn states its inertia about that axis only.
void add_inertia(OpenfastImport& import, Deck& deck, const std::string& side, Body& body) {
  const std::string key = side + "Iner";
  const Vector3 axis = axis_of(deck.number(side + "Skew"), deck.number(side + "Tilt"));
  const Vector3 arm = body.center - deck.point(side + "Pnt", "n");
  const double shift = body.mass * arm.cross(axis).squaredNorm();
  const double own = deck.number(key) - shift;
  import.require(own >= 0.0, deck, key,
                 "less than mass times squared distance from the furl axis = " + rounded(shift) +
                     ", which no body has");
  body.inertia = own * axis * axis.transpose();
}

}  // namespace

void add_locked_furling(OpenfastImport& import, Deck& elastodyn) {
  import.say(elastodyn, "Furling", Fate::derived, "True, but rotor-furl and tail-furl are locked");
  const std::unique_ptr<Deck> file = import.open(elastodyn.file("FurlFile"));
  if (!file) return;
  Deck& deck = *file;
  import.say(elastodyn, "FurlFile", Fate::taken, "read");
  model::NacelleDefinition& definition = import.turbine.nacelle;

  const auto body = [&](const std::string& mass, const std::string& center) {
    const Body result{deck.number(mass), deck.point(center, "n"), Matrix3::Zero()};
    import.require(result.mass >= 0.0, deck, mass, "expected a number >= 0");
    return result;
  };
  Body nacelle{
      definition.mass,
      {definition.center_of_mass(1), -definition.center_of_mass(0), definition.center_of_mass(2)},
      Matrix3::Zero()};
  nacelle.inertia.diagonal() << definition.inertia(1), definition.inertia(0), definition.inertia(2);
  std::array<Body, 4> bodies{nacelle, body("RFrlMass", "RFrlCM"), body("BoomMass", "BoomCM"),
                             body("TFinMass", "TFinCM")};
  Body& tail = bodies[2];
  if (bodies[1].mass > 0.0) add_inertia(import, deck, "RFrl", bodies[1]);
  if (tail.mass > 0.0) add_inertia(import, deck, "TFrl", tail);

  Body whole;
  for (const Body& part : bodies) {
    whole.mass += part.mass;
    whole.center += part.mass * part.center;
  }
  if (whole.mass > 0.0) whole.center /= whole.mass;
  for (const Body& part : bodies) {
    const Vector3 arm = part.center - whole.center;
    whole.inertia += part.inertia +
                     part.mass * (arm.squaredNorm() * Matrix3::Identity() - arm * arm.transpose());
  }
  definition.mass = whole.mass;
  definition.center_of_mass = {-whole.center(1), whole.center(0), whole.center(2)};
  definition.inertia = {whole.inertia(1, 1), whole.inertia(0, 0), whole.inertia(2, 2)};
  const double products = std::max({std::abs(whole.inertia(0, 1)), std::abs(whole.inertia(0, 2)),
                                    std::abs(whole.inertia(1, 2))});
  for (const char* key : {"RFrlMass", "BoomMass", "TFinMass", "RFrlIner", "TFrlIner"})
    import.say(deck, key, Fate::derived,
               "part of nacelle.mass, center_of_mass and inertia, " + rounded(whole.mass) +
                   " kg together; products of inertia, up to " + rounded(products) +
                   " kg m^2, are left out: a case has none");
  for (const char* key : {"nacelle.mass", "nacelle.center_of_mass", "nacelle.inertia"})
    import.note(key, "with the bodies of the furling file");
  std::string also;
  for (const char* key : {"Yaw2Shft", "ShftSkew"})
    if (deck.number_or(key, 0.0) != 0.0)
      also += std::string("; ") + key + " = " + rounded(deck.number(key)) +
              " is left out, for the shaft of a case meets the yaw axis";
  import.warn(elastodyn.place_of("Furling"),
              "Furling: warning: rotor-furl and tail-furl are locked at 0; their masses are part "
              "of the nacelle" +
                  also);
  import.report_unused(deck);
}

}  // namespace samara::decks
