#include "import_servodyn.hpp"

#include <cmath>

#include "samara/fields/field.hpp"

namespace samara::decks {
namespace {

constexpr double percent = 0.01;

/// Smallest and largest rated speed of the generator by the speed of the deck times the gear ratio.
constexpr double slowest = 0.5;
constexpr double fastest = 4.0;

/// OpenFAST's decks have this where a key is not used.
constexpr double unused_rpm = 9999.9;

/// The rated speed of the rotor, where it may be that of this deck.
bool set_rated_speed(OpenfastImport& import, Deck& servo, const char* key, double generator_speed,
                     double rotor_speed) {
  const double rated = generator_speed / std::abs(import.turbine.shaft.gear_ratio);
  const bool is_far =
      rotor_speed > 0.0 && !(rated > slowest * rotor_speed && rated < fastest * rotor_speed);
  const bool is_unused = servo.number(key) == unused_rpm;
  if (is_far || is_unused) {
    const std::string why = is_unused ? "the value of keys that are not used"
                                      : "a speed of the generator that is far from RotSpeed times "
                                        "GBRatio";
    import.warn(servo.place_of(key),
                std::string(key) + ": warning: " + why +
                    ", so that the law of the torque is left out; hint: operation of the case");
    return false;
  }
  import.operation.rated_speed = rated;
  return true;
}

/// Torque in proportion to the square of the speed, then constant.
void read_variable_speed(OpenfastImport& import, Deck& servo, double rotor_speed) {
  const double speed = fields::rpm.to_si(servo.number("VS_RtGnSp"));
  const double torque = servo.number("VS_RtTq");
  const double gain = servo.number("VS_Rgn2K");
  import.require(speed > 0.0, servo, "VS_RtGnSp", "expected a number > 0");
  import.require(torque >= 0.0, servo, "VS_RtTq", "expected a number >= 0");
  import.require(gain >= 0.0, servo, "VS_Rgn2K", "expected a number >= 0");
  if (!(speed > 0.0 && torque > 0.0 && gain > 0.0)) return;
  if (!set_rated_speed(import, servo, "VS_RtGnSp", speed, rotor_speed)) return;
  const double per_rpm = fields::rpm.to_si(1.0);
  import.operation.rated_power = speed * torque;
  import.operation.torque_gain = gain / (per_rpm * per_rpm);
  import.say(servo, "VS_RtGnSp", Fate::derived, "operation.rated_speed_rpm: by GBRatio");
  import.say(servo, "VS_RtTq", Fate::derived, "operation.rated_power: VS_RtGnSp x VS_RtTq");
  import.say(servo, "VS_Rgn2K", Fate::derived, "operation.torque_gain");
  import.ignore(servo, "VS_SlPc",
                "between the law of the square and the rated torque operating points hold the "
                "rated speed");
  import.note("operation.rated_speed_rpm", "VS_RtGnSp/GBRatio");
  import.note("operation.rated_power", "VS_RtGnSp x VS_RtTq, without the losses of GenEff");
  import.note("operation.torque_gain", "VS_Rgn2K");
}

/// Torque in proportion to the slip, up to the pull-out torque.
void read_induction_generator(OpenfastImport& import, Deck& servo, double rotor_speed) {
  const double synchronous = fields::rpm.to_si(servo.number("SIG_SySp"));
  const double slip = servo.number("SIG_SlPc") * percent;
  const double torque = servo.number("SIG_RtTq");
  const double pull_out = servo.number("SIG_PORt");
  import.require(synchronous > 0.0, servo, "SIG_SySp", "expected a number > 0");
  import.require(slip > 0.0, servo, "SIG_SlPc", "expected a number > 0");
  import.require(torque > 0.0, servo, "SIG_RtTq", "expected a number > 0");
  import.require(pull_out >= 1.0, servo, "SIG_PORt", "expected a number >= 1");
  if (!(synchronous > 0.0 && slip > 0.0 && torque > 0.0 && pull_out >= 1.0)) return;
  const double fastest_speed = synchronous * (1.0 + slip * pull_out);
  if (!set_rated_speed(import, servo, "SIG_SySp", fastest_speed, rotor_speed)) return;
  import.operation.torque_table = {{synchronous, 0.0}, { fastest_speed, pull_out * torque }};
  import.operation.rated_power = fastest_speed * pull_out * torque;
  const std::string table = "operation.torque_table";
  for (const char* key : {"SIG_SySp", "SIG_SlPc", "SIG_RtTq", "SIG_PORt"})
    import.say(servo, key, Fate::derived, table + ", up to the pull-out torque");
  import.note("operation.torque_table",
              "SIG_SySp without torque, and SIG_PORt times SIG_RtTq at SIG_PORt times SIG_SlPc");
  import.note("operation.rated_speed_rpm", "of the pull-out torque");
  import.note("operation.rated_power", "of the pull-out torque");
}

void say_law(OpenfastImport& import, Deck& servo, const char* key) {
  const bool has_law = import.operation.rated_speed > 0.0;
  import.say(servo, key, has_law ? Fate::taken : Fate::ignored,
             has_law ? "1: the law of operation" : "1: without a law of operation");
}

}  // namespace

void read_generator_law(OpenfastImport& import, Deck& servo, double rotor_speed) {
  if (!servo.has("VSContrl") || import.turbine.shaft.gear_ratio == 0.0) return;
  const double control = servo.number("VSContrl");
  if (control == 1.0) {
    read_variable_speed(import, servo, rotor_speed);
    return say_law(import, servo, "VSContrl");
  }
  if (control == 0.0 && servo.has("GenModel") && servo.number("GenModel") == 1.0) {
    read_induction_generator(import, servo, rotor_speed);
    return say_law(import, servo, "GenModel");
  }
  import.say(servo, "VSContrl", Fate::ignored,
             control == 0.0 ? "0: the generator of GenModel has no law of a case"
                            : "the law of the torque is that of a routine or a library; hint: "
                              "operation, transient.controller");
}

}  // namespace samara::decks
