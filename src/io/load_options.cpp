#include <array>

#include "samara/fields/turbine_fields.hpp"
#include "samara/io/load_result.hpp"

#include "field_reader.hpp"
#include "yaml_settings.hpp"

namespace samara::io {
namespace {

using fields::Field;

constexpr int most_bins = 10000;
constexpr int most_azimuths = 100000;
constexpr fields::Range woehler{"a number >= 1", 1.0};

}  // namespace

void declare(fields::Visitor& fields, LoadOptions& options) {
  loads::LoadEvaluationOptions& evaluation = options.evaluation;
  fields.name_list(
      Field("channels", "names; `Azimuth` is evaluated only if it is named here").or_else("all"),
      options.channels);
  fields.number(Field("from", "s", "first time of the rows").or_else("that of the first row"),
                options.from);
  fields.number(Field("until", "s", "last time, more than `from`").or_else("that of the last row"),
                options.until);
  if (options.from && options.until && !(*options.from < *options.until))
    fields.expected("until", "more than from");
  fields.integer({"azimuths", "", fields::integers(2, most_azimuths),
                  "instants per revolution of a steady state"},
                 options.azimuths);
  fields.number_list({"exponents", "", woehler, "exponents m of the S-N curves"}, "numbers",
                     evaluation.exponents);
  fields.number(
      {"equivalent_frequency", "Hz", fields::positive, "frequency of the equivalent cycles"},
      evaluation.frequency);
  fields.integer(
      {"harmonics", "", fields::integers(0, fields::most_harmonics),
       "harmonics of the rotor speed, over the last whole revolutions. If the channel `Azimuth` "
       "is missing or there is no whole revolution, they are left out, unless this key "
       "is given"},
      evaluation.harmonics);
  if (fields.reads()) evaluation.harmonics_are_asked_for = fields.given("harmonics");
  std::array<int, 2> bins{evaluation.range_bins, evaluation.mean_bins};
  fields.integers(
      {"bins", "", fields::integers(1, most_bins),
       "bins of ranges and means in the rainflow table: one number, or `[ranges, means]`"},
      bins);
  evaluation.range_bins = bins[0];
  evaluation.mean_bins = bins[1];
  fields.named(Field("goodman",
                     "by channel, `{RootMyb1: {ultimate_load: 2e4}}`: converts the cycles of that "
                     "channel to one mean before their damage is counted")
                   .or_else("absent"),
               "channels, e.g. {RootMyb1: {ultimate_load: 2e4}}", options.goodman,
               [&](loads::GoodmanCorrection& correction) {
                 fields.number(Field("ultimate_load", "of the channel", fields::positive, "")
                                   .required("in the unit of the channel"),
                               correction.ultimate_load);
                 fields.number(
                     {"fixed_mean", "of the channel", "mean to which the cycles are converted"},
                     correction.fixed_mean);
               });
  fields.number_list(
      Field("hours", "h", fields::non_negative,
            "hours of the lifetime that each result represents, one number per result; "
            "required with several results")
          .or_else("absent"),
      "numbers", options.hours);
  fields.number(
      Field("equivalent_cycles", "", fields::positive,
            "cycles of the lifetime, instead of `equivalent_frequency` times the sum of `hours`")
          .or_else("absent"),
      options.equivalent_cycles);
  if (options.equivalent_cycles && options.hours.empty())
    fields.refuse("equivalent_cycles",
                  "needs a lifetime; hint: give hours=[...], one number per result");
}

LoadOptions read_load_options(const std::vector<std::string>& settings) {
  LoadOptions options;
  ErrorList errors("--set", settings);
  YamlNode root;
  root.kind = YamlNode::Kind::map;
  apply_settings(settings, root, errors);
  MapReader map(root, "", errors);
  FieldReader reader(map);
  declare(reader, options);
  map.finish();
  errors.throw_if_any();
  return options;
}

}  // namespace samara::io
