#include "samara/fields/turbine_fields.hpp"

namespace samara::fields {
namespace {

void declare_keys(Visitor& fields, model::OperatingPointsDefinition& operation) {
  fields.exclusive({{"torque_gain"}, {"torque_table"}});
  const auto declare_speed = [&fields](const Field& in_si, const Field& in_rpm, double& speed) {
    fields.number(in_si, in_rpm, speed);
  };
  fields.number_list(Field("wind_speeds", "m/s", positive,
                           "speeds of the wind, ascending, in place of `wind.speed`")
                         .or_else("those of `table`, else `wind.speed`"),
                     "wind speeds", operation.wind_speeds);
  declare_speed(Field("least_speed", "rad/s", positive,
                      "lowest speed of the rotor, which the generator holds where its law asks for "
                      "a lower one")
                    .none_at_zero("none"),
                Field("least_speed_rpm", rpm, positive, "the same, instead of `least_speed`")
                    .none_at_zero(""),
                operation.least_speed);
  declare_speed(
      Field("rated_speed", "rad/s", positive, "highest speed of the rotor").none_at_zero("none"),
      Field("rated_speed_rpm", rpm, positive, "the same, instead of `rated_speed`")
          .none_at_zero(""),
      operation.rated_speed);
  fields.number(Field("rated_power", "W", positive,
                      "torque of the generator times its speed, which the pitch holds from the "
                      "rated wind speed on")
                    .none_at_zero("none"),
                operation.rated_power);
  fields.number(Field("torque_gain", "N m s^2/rad^2", positive,
                      "between both speeds the torque of the generator is this gain times the "
                      "square of its speed")
                    .none_at_zero("none"),
                operation.torque_gain);
  fields.pairs(Field("torque_table", "rad/s, N m",
                     "instead of `torque_gain`: `[[speed, torque], ...]` of the generator, linear "
                     "between the entries")
                   .or_else("none"),
               {"speed", "torque"}, operation.torque_table);
  const auto declare_file = [&fields](const Field& field, std::string& path) {
    const bool has_name = fields.text(field, "the name of a file", path);
    if (has_name && path.empty()) fields.expected(field.key, "the name of a file");
  };
  declare_file(Field("table",
                     "instead of speeds, power and torque: file with rows of wind speed [m/s], "
                     "pitch [deg] and rotor speed [rpm] (HAWC2's .opt), linear between the rows. A "
                     "relative path is one from the current folder")
                   .or_else("none"),
               operation.table_path);
  declare_file(
      Field("opt", "name of a file in that form, to which the points are written").or_else("none"),
      operation.opt_path);
  for (std::size_t i = 1; i < operation.wind_speeds.size(); ++i)
    if (!(operation.wind_speeds[i] > operation.wind_speeds[i - 1])) {
      fields.refuse("wind_speeds", "must ascend");
      break;
    }
}

}  // namespace

void declare_operating_points(Visitor& fields, model::OperatingPointsDefinition& operation) {
  fields.block({"operation", "operating points over the wind speed, [below](#operation)"},
               [&] { declare_keys(fields, operation); });
}

}  // namespace samara::fields
