#include "air_fields.hpp"

#include <cmath>

namespace samara::fields {
namespace {

using model::AeroDefinition;
using model::AirfoilDefinition;
using model::WindDefinition;

constexpr Unit deg_per_m{"deg/m", deg.factor, deg.divisor};

constexpr Range shear_exponent{"a number from -1 to 1", -1.0, 1.0};
/// Below it the transition to static loads would begin at a negative angle.
constexpr Range cut_out_angle{"an angle from 5 to 180 degrees", 5.0, 180.0};
constexpr Range wake_shape_count{"whole numbers from 0 to 10", 0.0, 10.0};

// ---- wind --------------------------------------------------------------------------------------

void declare_shear(Visitor& fields, WindDefinition& wind) {
  using Profile = WindDefinition::Profile;
  fields.exclusive({{"power"}, {"log"}});
  fields.at_least_one({"power", "log", "left", "up"}, "or \"log\", \"left\", \"up\"");
  const auto declare_profile = [&](const Field& field, Profile profile, double& value) {
    if (fields.reads() && fields.given(field.key)) wind.profile = profile;
    const bool is_written = !fields.wants_all() && wind.profile == profile;
    if (fields.wants_all() || is_written) fields.number(field.required("", is_written), value);
  };
  declare_profile(Field("power", "", shear_exponent,
                        "exponent of the power law: speed x (z/height)^power at the height z. "
                        "Below 1 m the speed is that of about 1 m")
                      .or_else("none"),
                  Profile::power, wind.exponent);
  declare_profile(Field("log", "m", positive,
                        "instead of `power`: roughness length z0 of the logarithmic law, less than "
                        "`height`: speed x ln(z/z0)/ln(height/z0)")
                      .or_else("none"),
                  Profile::logarithmic, wind.roughness);
  fields.number({"left",
                 "change of the speed across `length` to the left of one who looks downwind, as a "
                 "part of `speed`; it is added to the profile"},
                wind.shear_left);
  fields.number({"up", "the same upward, 0 at `height`"}, wind.shear_up);
  fields.number(Field("length", "m", positive,
                      "of `left` and `up`, such as the diameter of the rotor; required beside them")
                    .none_at_zero(""),
                wind.shear_length);
}

void declare_tower_flow(Visitor& fields, model::TowerFlowDefinition& tower) {
  using Potential = elements::TowerPotential;
  using Wake = elements::TowerWake;
  fields.table(Field("sections", "m, m, 1",
                     "`[[height, diameter, drag], ...]`: height above the foot, rising, diameter "
                     "and drag coefficient of the round tower; constant beyond both ends")
                   .required("[[height, diameter, drag coefficient], ...]"),
               {{"height", Unit("m"), &tower.heights},
                {"diameter", Unit("m"), &tower.diameters},
                {"drag", Unit(""), &tower.drags}});
  fields.choice({"potential",
                 "flow ahead of the tower and beside it: `bak`, potential flow with the drag (Bak, "
                 "Madsen, Johansen 2001); `plain`, without it; `none`"},
                tower.potential,
                {{"bak", Potential::bak}, {"plain", Potential::plain}, {"none", Potential::none}});
  fields.choice({"wake",
                 "behind the tower: `powles`, a cosine; `eames`, a bell curve that widens with the "
                 "turbulence; `none`"},
                tower.wake,
                {{"none", Wake::none}, {"powles", Wake::powles}, {"eames", Wake::eames}});
  fields.number({"turbulence", "", positive, "intensity of the turbulence, of `eames`"},
                tower.turbulence);
  fields.flag({"drag_load", "the drag of the wind acts on the tower, if there is one"},
              tower.drag_load);
}

void declare_nacelle_drag(Visitor& fields, model::NacelleDragDefinition& nacelle) {
  fields.numbers(
      Field("areas", "m^2", non_negative, "projected areas along y1, y2 and y3 of the nacelle")
          .required(),
      nacelle.areas, false);
  fields.numbers(
      Field("drag", "", non_negative, "drag coefficients along the same axes").required(),
      nacelle.drags, true);
  fields.numbers({"center", "m", "place of the load, from the tower top in y1 y2 y3"},
                 nacelle.center, false);
}

void declare_wind_keys(Visitor& fields, WindDefinition& wind) {
  fields.number(Field("speed", "m/s", non_negative, "at `height`").required(), wind.speed);
  fields.number(Field("height", "m", positive,
                      "above the foot of the tower, where the wind is `speed` and "
                      "`direction_deg`; required beside `veer_deg` and beside `power`, `log` or "
                      "`up` of `shear`")
                    .none_at_zero(""),
                wind.height);
  fields.block(Field("shear", "change of the speed with the place, [below](#wind)").or_else("none"),
               Presence{[&wind] {
                          return wind.profile != WindDefinition::Profile::uniform ||
                                 wind.shear_left != 0.0 || wind.shear_up != 0.0;
                        },
                        [] {}},
               [&] { declare_shear(fields, wind); });
  fields.number({"direction_deg", deg, half_turn,
                 "0: along n2; > 0: turned counter-clockwise, seen from above"},
                wind.direction);
  fields.number({"veer_deg", deg_per_m, any_number,
                 "change of the direction with the height, > 0 counter-clockwise upward"},
                wind.veer);
  fields.number({"upflow_deg", deg, quarter_turn, "> 0: the wind rises"}, wind.upflow);
  fields.number({"density", "kg/m^3", positive, "of the air"}, wind.density);
  fields.block(Field("tower", "flow around the tower, [below](#wind)").or_else("none"), wind.tower,
               [&](model::TowerFlowDefinition& tower) { declare_tower_flow(fields, tower); });
  fields.block(Field("nacelle", "drag of the wind on the nacelle, [below](#wind)").or_else("none"),
               wind.nacelle, [&](model::NacelleDragDefinition& nacelle) {
                 declare_nacelle_drag(fields, nacelle);
               });
}

// ---- models ------------------------------------------------------------------------------------

void declare_skew(Visitor& fields, double& skew) {
  bool is_pitt_peters = skew == elements::pitt_peters_skew;
  bool is_none = skew == 0.0;
  fields.number({"skew", "", non_negative,
                 "factor of the skewed wake: in wind across the shaft the induced velocity grows "
                 "to the downstream side of the rotor. `pitt_peters` is 15 pi/32, `none` is 0"},
                skew, {{"pitt_peters", &is_pitt_peters}, {"none", &is_none}});
  if (!fields.reads()) return;
  if (is_pitt_peters) skew = elements::pitt_peters_skew;
  if (is_none) skew = 0.0;
}

void declare_tau1(Visitor& fields, std::optional<double>& tau1) {
  bool is_auto = !tau1.has_value();
  double value = tau1.value_or(1.0);
  fields.number({"tau1", "s", positive,
                 "first time constant of `inflow: oye`; `auto`: from the wind and the mean "
                 "induction of the rigid rotor"},
                value, {{"auto", &is_auto}});
  if (fields.reads()) tau1 = is_auto ? std::optional<double>() : value;
}

void declare_wake_shapes(Visitor& fields, std::vector<int>& shapes) {
  std::vector<double> counts(shapes.begin(), shapes.end());
  fields.number_list(
      {"wake_shapes", "", wake_shape_count,
       "`[N0, N1, ...]` of `inflow: peters_he`: number of shapes over the radius of "
       "the mean, of the first harmonic over the azimuth and so on; N0 is 1 or more"},
      "numbers", counts);
  if (!fields.reads()) return;
  for (const double count : counts)
    if (count != std::round(count))
      return fields.expected("wake_shapes", "whole numbers, such as [3, 2, 2, 1, 1]");
  shapes.clear();
  for (const double count : counts) shapes.push_back(static_cast<int>(count));
}

void declare_inflow(Visitor& fields, AeroDefinition& aero) {
  using model::Induction;
  using model::Inflow;
  using model::MomentumLoad;
  using model::ThrustLaw;
  fields.choice(
      {"induction",
       "induced velocity from the balance of momentum: `full`, along the shaft and around it; "
       "`axial`, along the shaft alone; `none`"},
      aero.induction,
      {{"full", Induction::full}, {"axial", Induction::axial}, {"none", Induction::none}});
  fields.choice(
      {"inflow",
       "`oye`: the induced velocity follows its quasi-steady value with two lags in "
       "series (Oye 1990); `equilibrium`: it is that value; `frozen`: it is that value in "
       "the steady state, and motions about it do not change it (not in time series); "
       "`peters_he`: along the shaft it is that of finite states of the whole rotor (Peters, He "
       "1991); `thrust`, `tip_loss`, `hub_loss`, `axial_drag`, `skew` and `tau1` have no effect "
       "then, "
       "and `closure` acts on the velocity around the shaft"},
      aero.inflow,
      {{"oye", Inflow::oye},
       {"equilibrium", Inflow::equilibrium},
       {"frozen", Inflow::frozen},
       {"peters_he", Inflow::peters_he}});
  declare_wake_shapes(fields, aero.wake_shapes);
  declare_tau1(fields, aero.tau1);
  fields.choice({"closure",
                 "load in the balance of momentum: `equilibrium`, of the polars at the "
                 "quasi-steady induced velocity; `load`, of the airfoil dynamics"},
                aero.closure,
                {{"equilibrium", MomentumLoad::equilibrium}, {"load", MomentumLoad::actual}});
  fields.choice({"thrust",
                 "thrust of an annulus over its induction: `glauert_skew`, with the wind in the "
                 "plane of the rotor; `buhl`, of axial wind; `buhl_f`, the same with the tip loss "
                 "in its coefficients (AeroDyn); `madsen`, the polynomial of Madsen et al. (2020, "
                 "HAWC2)"},
                aero.thrust,
                {{"glauert_skew", ThrustLaw::glauert_skew},
                 {"buhl", ThrustLaw::buhl},
                 {"buhl_f", ThrustLaw::buhl_f},
                 {"madsen", ThrustLaw::madsen}});
  fields.flag({"tip_loss", "Prandtl's factor of the blade tips"}, aero.tip_loss);
  fields.flag({"hub_loss", "the same of the blade roots"}, aero.hub_loss);
  fields.flag({"axial_drag", "the drag takes part in the axial balance of momentum"},
              aero.axial_drag);
  fields.flag({"tangential_drag", "and in the tangential one"}, aero.tangential_drag);
  declare_skew(fields, aero.skew);
}

void declare_dynamics(Visitor& fields, AeroDefinition& aero) {
  using model::AirfoilDynamics;
  fields.choice({"airfoil_dynamics",
                 "`hgm`: shed wake, lag of the pressure and lag of the separation (Hansen, Gaunaa, "
                 "Madsen 2004); `oye`: lag of the separation; `quasi_steady`: the polar at the "
                 "angle of attack at three quarters of the chord; `static`: the polar at that at "
                 "the aerodynamic centre; `peters`: shed wake of attached flow by six states "
                 "(Peters, Karunamoorthy, Cao 1995), with the slope of the lift alone"},
                aero.dynamics,
                {{"hgm", AirfoilDynamics::hgm},
                 {"oye", AirfoilDynamics::oye},
                 {"quasi_steady", AirfoilDynamics::quasi_steady},
                 {"static", AirfoilDynamics::static_polar},
                 {"peters", AirfoilDynamics::peters}});
  bool is_jones = aero.wake == elements::jones_constants;
  fields.numbers({"wake_constants", "", non_negative,
                  "`[A1, A2, b1, b2]` of the shed wake of `hgm`: lift deficits, and their decay "
                  "rates > 0 per half chord travelled; `jones`: those of a flat plate, `[0.165, "
                  "0.335, 0.0455, 0.3]`"},
                 aero.wake, false, {{"jones", &is_jones}});
  if (fields.reads() && is_jones) aero.wake = elements::jones_constants;
  fields.number({"T_p", "c/(2 U)", positive,
                 "time constant of the lag of the pressure, by chord and relative velocity"},
                aero.pressure_lag);
  fields.number({"T_f", "c/(2 U)", positive, "the same of the lag of the separation"},
                aero.separation_lag);
  fields.number({"cut_out_deg", deg, cut_out_angle,
                 "angle of attack beyond which loads are those of the polars; the transition "
                 "begins 5 degrees before it"},
                aero.cut_out);
  fields.flag({"added_mass",
               "inertia of the air that an accelerated section moves: small for the blades of wind "
               "turbines, needed for light wings"},
              aero.added_mass);
}

// ---- blades ------------------------------------------------------------------------------------

void declare_polar(Visitor& fields, bool is_single, model::PolarDefinition& polar) {
  fields.number(
      Field("reynolds", "", positive,
            "Reynolds number; required where there are several polars. The coefficients "
            "are linear in its logarithm between them")
          .none_at_zero("not known")
          .required("the Reynolds number, by which several polars are told apart", !is_single),
      polar.reynolds);
  fields.table(Field("table", "deg, 1, 1, 1",
                     "`[[angle, Cl, Cd, Cm], ...]`: lift, drag and moment (nose up, about the "
                     "aerodynamic centre) at rising angles of attack from -180 to 180")
                   .required("[[angle, Cl, Cd, Cm], ...] from -180 to 180 degrees"),
               {{"angle", deg, &polar.angles},
                {"Cl", Unit(""), &polar.lift},
                {"Cd", Unit(""), &polar.drag},
                {"Cm", Unit(""), &polar.moment}});
}

void declare_airfoil(Visitor& fields, AirfoilDefinition& airfoil) {
  fields.exclusive({{"polars"}, {"file"}});
  fields.at_least_one({"polars", "file"}, "or \"file\"");
  if (fields.wants_all() || airfoil.polars.empty())
    fields.text(Field("file",
                      "instead of `polars`: a [polar file](#polar-files), by its path from the "
                      "folder of the case")
                    .or_else(""),
                "the name of a file", airfoil.file);
  fields.list(Field("polars", "list of [polars](#airfoils), one for each Reynolds number")
                  .or_else("those of `file`"),
              "polars", 1, airfoil.polars, [&](model::PolarDefinition& polar) {
                declare_polar(fields, airfoil.polars.size() < 2, polar);
              });
  fields.number(Field("thickness", "", beyond_the_root, "relative to the chord").or_else("none"),
                airfoil.thickness);
  fields.number(Field("lift_slope", "1/rad", positive,
                      "of the attached flow, where that of the polar is not smooth")
                    .or_else("that of the polar"),
                airfoil.lift_slope);
}

void declare_aero_section(Visitor& fields, bool is_single, model::AeroSectionDefinition& section) {
  fields.number(Field("at", "", fraction_of_one,
                      "place as a fraction of the length, rising from section to section; required "
                      "where there are several")
                    .required("the fraction of the length, from 0 to 1", !is_single),
                section.at);
  fields.number(Field("chord", "m", positive, "").required(), section.chord);
  fields.number({"twist_deg", deg, half_turn,
                 "of the chord from the b2 of the root, > 0 toward feather. The twist of the "
                 "structural sections is not added"},
                section.twist);
  fields.exclusive({{"airfoil"}, {"thickness"}});
  fields.at_least_one({"airfoil", "thickness"}, "a name of blades.airfoils, or a thickness");
  fields.text(Field("airfoil",
                    "a name of `airfoils`; between two sections the coefficients are linear along "
                    "the blade. Either this or `thickness`")
                  .or_else(""),
              "a name of blades.airfoils", section.airfoil);
  fields.number(Field("thickness", "", beyond_the_root,
                      "relative to the chord, instead of `airfoil` and at all sections: the "
                      "thickness is linear along the blade, and the coefficients are linear in it "
                      "between the airfoils of the next smaller and larger `thickness`")
                    .or_else("none"),
                section.thickness);
  fields.numbers({"center", "m",
                  "`[b2, b3]`, offset of the aerodynamic centre from the reference line, in the "
                  "axes of the structural section"},
                 section.center, false);
}

}  // namespace

void declare_airfoils(Visitor& fields, model::BladesDefinition& blades) {
  fields.named(Field("airfoils",
                     "[airfoils](#airfoils) by names that the case chooses: letters, "
                     "digits, spaces, `_`, `-` and `+`")
                   .or_else("none"),
               "airfoils by their names, {NAME: {file: FILE}}", blades.airfoils,
               [&](AirfoilDefinition& airfoil) { declare_airfoil(fields, airfoil); });
  fields.list(Field("aero_sections",
                    "list of [aerodynamic sections](#aerodynamic-sections); one entry is uniform"),
              "aerodynamic sections", 1, blades.aero_sections,
              [&](model::AeroSectionDefinition& section) {
                declare_aero_section(fields, blades.aero_sections.size() < 2, section);
              });
}

void declare_wind(Visitor& fields, model::TurbineDefinition& turbine) {
  fields.block(Field("wind", "the mean wind, [below](#wind)").or_else("none"), turbine.wind,
               [&](WindDefinition& wind) { declare_wind_keys(fields, wind); });
}

void declare_aero(Visitor& fields, model::TurbineDefinition& turbine) {
  const bool has_air = turbine.wind && !turbine.blades.aero_sections.empty();
  if (fields.reads() && !fields.given("aero") && has_air) turbine.aero.emplace();
  enum class Air { none, models };
  Air air = turbine.aero ? Air::models : Air::none;
  const Field field =
      Field("aero",
            "models of the air at the blades, [below](#aero), or `none`: no loads of the air, "
            "although there are `wind` and `blades.aero_sections`")
          .or_else("all defaults beside `wind` and `blades.aero_sections`");
  fields.two_ways(
      field, "models",
      [&] {
        // Written where the default would be models.
        const bool is_written = !fields.wants_all() && !turbine.aero && has_air;
        if (fields.wants_all() || is_written)
          fields.choice(field.required("", is_written), air, {{"none", Air::none}});
      },
      [&] {
        fields.block(field, turbine.aero, [&](AeroDefinition& aero) {
          declare_inflow(fields, aero);
          declare_dynamics(fields, aero);
        });
      });
}

}  // namespace samara::fields
