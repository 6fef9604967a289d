#include "import_elastodyn.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/LU>

#include "import_common.hpp"

namespace samara::decks {
namespace {

constexpr int integration_steps = 2000;

/// The coefficients of a mode shape add up to 1 within this.
constexpr double shape_tolerance = 0.015;

/// The last row of a table is at 1 within this.
constexpr double grid_tolerance = 1e-9;

constexpr int most_rows = 100000;

/// A damping ratio is met within this.
constexpr double met_ratio = 1e-9;

/// A direction in which a beam of ElastoDyn bends, with the names of its keys in the deck.
struct Direction {
  std::string stiffness;            ///< column
  std::string factor;               ///< of this column
  std::vector<std::string> shapes;  ///< of the modes, each of five coefficients
  std::vector<std::string> ratios;
  std::vector<std::string> tuners;  ///< of the stiffness of each mode, or none
  std::string bending;              ///< "2" or "3": about b2 or b3
  bool bends = true;
};

/// A beam of ElastoDyn, with the names in its file and in the case.
struct BeamWords {
  std::string block;  ///< of the case
  std::string count;
  std::string place;
  std::string twist;  ///< empty for a tower
  std::string mass;
  std::string mass_factor;
  std::array<Direction, 2> directions;
};

/// A mode of ElastoDyn.
struct AssumedMode {
  double frequency = 0.0;  ///< [rad/s]
  double share = 1.0;      ///< of its modal mass, by the motion along the section's own axis
  double ratio = 0.0;      ///< of damping
  std::string key;         ///< of the ratio
};

/// The mode of an assumed shape, sum c_k x^k with k from 2, without the masses at its end:
/// stiffness along the local principal direction, which the twist turns.
AssumedMode assumed_mode(const std::array<double, 5>& coefficients, const Curve& mass,
                         const Curve& stiffness, const Curve& twist, double length) {
  const double h = 1.0 / integration_steps;
  std::complex<double> slope = 0.0;
  std::complex<double> place = 0.0;
  double generalized_mass = 0.0;
  double along_own_axis = 0.0;
  double generalized_stiffness = 0.0;
  for (int i = 0; i < integration_steps; ++i) {
    const double x = (i + 0.5) * h;
    const Station station{x, false};
    double curvature = 0.0;
    for (int k = 6; k >= 2; --k)
      curvature = curvature * x + coefficients[static_cast<std::size_t>(k - 2)] * k * (k - 1);
    const std::complex<double> axis =
        std::polar(1.0, interpolate(twist, station) * std::numbers::pi / 180.0);
    const std::complex<double> middle = place + 0.5 * h * slope + 0.125 * h * h * curvature * axis;
    const double step_mass = interpolate(mass, station) * h * length;
    generalized_mass += step_mass * std::norm(middle);
    along_own_axis += step_mass * std::pow((middle * std::conj(axis)).real(), 2);
    generalized_stiffness +=
        interpolate(stiffness, station) * curvature * curvature * h / (length * length * length);
    place += h * slope + 0.5 * h * h * curvature * axis;
    slope += h * curvature * axis;
  }
  AssumedMode mode;
  mode.frequency = std::sqrt(generalized_stiffness / generalized_mass);
  mode.share = along_own_axis / generalized_mass;
  return mode;
}

std::array<double, 5> read_shape(OpenfastImport& import, Deck& deck, const std::string& shape,
                                 const std::string& target) {
  std::array<double, 5> coefficients{};
  double sum = 0.0;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    const std::string key = shape + "(" + std::to_string(k + 2) + ")";
    coefficients[k] = deck.number(key);
    sum += coefficients[k];
    import.say(deck, key, Fate::derived, "the shape from which " + target + " follows");
  }
  import.require(std::abs(sum - 1.0) <= shape_tolerance, deck, shape + "(2)",
                 "the coefficients of a mode shape add up to 1, these to " + rounded(sum));
  return coefficients;
}

/// Strain-rate damping mu [s] and mass damping alpha [1/s].
struct DampingPair {
  double mu = 0.0;
  double alpha = 0.0;
  double ratio(const AssumedMode& mode) const {
    return 0.5 * (mu * mode.frequency + alpha * mode.share / mode.frequency);
  }
};

/// The pair that meets the ratios of one or two modes. Where this pair has a negative constant,
/// only the one of the two constants that is nearer to both ratios by least squares.
DampingPair fit_pair(const std::vector<AssumedMode>& modes) {
  Eigen::MatrixX2d by_constant(static_cast<Eigen::Index>(modes.size()), 2);
  Eigen::VectorXd ratios(by_constant.rows());
  for (Eigen::Index i = 0; i < by_constant.rows(); ++i) {
    const AssumedMode& mode = modes[static_cast<std::size_t>(i)];
    by_constant.row(i) << 0.5 * mode.frequency, 0.5 * mode.share / mode.frequency;
    ratios(i) = mode.ratio;
  }
  if (modes.size() == 2) {
    const Eigen::Vector2d scale = by_constant.colwise().norm().cwiseInverse();
    const Eigen::Vector2d both =
        scale.asDiagonal() * (by_constant * scale.asDiagonal()).fullPivLu().solve(ratios);
    if (both.allFinite() && both.minCoeff() >= 0.0 &&
        (by_constant * both - ratios).norm() <= met_ratio * (1.0 + ratios.norm()))
      return {both(0), both(1)};
  }
  const auto nearest = [&](Eigen::Index kind) {
    return by_constant.col(kind).dot(ratios) / by_constant.col(kind).squaredNorm();
  };
  const auto distance = [&](Eigen::Index kind) {
    return (by_constant.col(kind) * nearest(kind) - ratios).norm();
  };
  if (modes.size() == 1 || distance(0) <= distance(1)) return {nearest(0), 0.0};
  return {0.0, nearest(1)};
}

/// Damping of a direction by the ratios of its modes, at rest and without masses at the end, as in
/// ElastoDyn.
DampingPair fit_damping(OpenfastImport& import, Deck& deck, const BeamWords& words,
                        const Direction& direction, const Curve& mass, const Curve& stiffness,
                        const Curve& twist, double length) {
  const std::string target = words.block + ".damping of bending " + direction.bending;
  std::vector<AssumedMode> modes;
  double first_tuner = 1.0;
  for (std::size_t mode = 0; mode < direction.shapes.size(); ++mode) {
    const std::array<double, 5> coefficients =
        read_shape(import, deck, direction.shapes[mode], target);
    const std::string& key = direction.ratios[mode];
    const double ratio = 0.01 * deck.number(key);
    import.require(ratio >= 0.0, deck, key, "expected a number >= 0");
    const bool has_tuner = mode < direction.tuners.size();
    const double tuner = has_tuner ? deck.number(direction.tuners[mode]) : 1.0;
    if (has_tuner)
      import.require(tuner > 0.0, deck, direction.tuners[mode], "expected a number > 0");
    if (mode == 0) first_tuner = tuner;
    if (!import.errors.empty()) continue;
    AssumedMode found = assumed_mode(coefficients, mass, stiffness, twist, length);
    found.frequency *= std::sqrt(tuner / first_tuner);  // `stiffness` contains the first already
    found.ratio = ratio;
    found.key = key;
    modes.push_back(found);
    if (mode == 0 && has_tuner)
      import.say(deck, direction.tuners[mode], Fate::derived,
                 "multiplies the stiffness of all sections");
    else if (has_tuner)
      import.say(deck, direction.tuners[mode], tuner == first_tuner ? Fate::derived : Fate::ignored,
                 tuner == first_tuner
                     ? "the same as the first, which multiplies the stiffness"
                     : rounded(tuner) + " differs from the first, " + rounded(first_tuner) +
                           ", which multiplies the stiffness of all modes");
  }
  if (!import.errors.empty()) return {};
  const DampingPair pair = fit_pair(modes);
  for (const AssumedMode& mode : modes) {
    const double given = pair.ratio(mode);
    const std::string stated = rounded(100.0 * mode.ratio, 4) + " % at the " +
                               rounded(mode.frequency * 0.5 / std::numbers::pi, 5) +
                               " Hz of the assumed shape";
    import.say(deck, mode.key, Fate::derived,
               target + " = " + rounded(pair.mu, 5) +
                   " s and mass_damping = " + rounded(pair.alpha, 5) + " 1/s, from " + stated);
    if (std::abs(given - mode.ratio) > met_ratio)
      import.warn(deck.place_of(mode.key),
                  mode.key + ": note: " + stated + " is not met, the mode gets " +
                      rounded(100.0 * given, 4) +
                      " %: no damping in proportion to stiffness and mass that is not negative "
                      "meets both ratios of the direction");
  }
  return pair;
}

/// A single row is a uniform beam.
void check_grid(OpenfastImport& import, const Deck& deck, const DeckTable& table,
                const std::string& name) {
  if (table.columns.empty() || table.columns[0].empty()) return;
  const std::vector<double>& grid = table.columns[0];
  for (std::size_t i = 1; i < grid.size(); ++i)
    if (!(grid[i] > grid[i - 1]))
      import.errors.add(deck.place(table.lines[i]),
                        name + ": expected more than the row before has, " + rounded(grid[i - 1]));
  if (grid.front() != 0.0)
    import.errors.add(deck.place(table.lines.front()), name + ": the first row must be at 0");
  if (grid.size() > 1 && std::abs(grid.back() - 1.0) > grid_tolerance)
    import.errors.add(deck.place(table.lines.back()), name + ": the last row must be at 1");
}

void say_columns(OpenfastImport& import, const Deck& deck, const DeckTable& table,
                 const std::vector<std::pair<std::string, std::string>>& used) {
  for (const std::string& name : table.names) {
    const auto found = std::find_if(used.begin(), used.end(),
                                    [&](const auto& entry) { return entry.first == name; });
    if (found != used.end())
      import.say_line(deck, table.line, name, Fate::taken, "sections: " + found->second);
    else
      import.say_line(deck, table.line, name, Fate::ignored, "ElastoDyn's beams do not use it");
  }
}

/// Bending only, no rotary inertia.
void build_sections(OpenfastImport& import, const Deck& deck, const DeckTable& table,
                    const BeamWords& words, const Curve& mass,
                    const std::array<Curve, 2>& stiffness, const Curve* twist,
                    model::BeamDefinition& beam) {
  for (std::size_t i = 0; i < table.lines.size(); ++i) {
    const auto check = [&](const std::string& name, double value) {
      if (!(value > 0.0))
        import.errors.add(
            deck.place(table.lines[i]),
            name + ": " + rounded(value) + ", expected a number > 0, factors included");
    };
    model::SectionDefinition section;
    section.at = std::min(table.columns[0][i], 1.0);
    check(words.mass, mass.values[i]);
    section.mass = build_mass_matrix(mass.values[i], Vector3::Zero());
    section.rigid = {true, true, true, true, true, true};
    for (std::size_t k = 0; k < 2; ++k) {
      check(words.directions[k].stiffness, stiffness[k].values[i]);
      if (!words.directions[k].bends) continue;
      section.rigid[4 + k] = false;
      section.stiffness.diagonal()(static_cast<Eigen::Index>(4 + k)) = stiffness[k].values[i];
    }
    if (twist != nullptr) section.twist = fields::deg.to_si(twist->values[i]);
    beam.sections.push_back(section);
  }
}

/// Fills sections and damping of a beam whose length is known.
void read_beam(OpenfastImport& import, Deck& deck, const BeamWords& words,
               model::BeamDefinition& beam) {
  std::vector<std::string> order{words.count};
  for (const Direction& direction : words.directions)
    order.insert(order.end(), direction.ratios.begin(), direction.ratios.end());
  for (const Direction& direction : words.directions)
    order.insert(order.end(), direction.tuners.begin(), direction.tuners.end());
  order.push_back(words.mass_factor);
  for (const Direction& direction : words.directions) order.push_back(direction.factor);
  for (const Direction& direction : words.directions)
    for (const std::string& shape : direction.shapes)
      for (int k = 2; k <= 6; ++k) order.push_back(shape + "(" + std::to_string(k) + ")");
  deck.set_order(order);

  const bool has_count = deck.has(words.count);
  const auto count = deck.number(words.count);
  if (has_count && !(count >= 1.0 && count <= most_rows && count == std::floor(count)))
    import.errors.add(deck.place_of(words.count),
                      words.count + ": expected an integer from 1 to " + std::to_string(most_rows));
  import.say(deck, words.count, Fate::derived, "the number of " + words.block + ".sections");
  std::vector<std::string> columns{words.place, words.mass};
  std::vector<std::pair<std::string, std::string>> meanings{
      {words.place, "at"}, {words.mass, "mass, times " + words.mass_factor}};
  std::array<double, 2> factors{};
  for (std::size_t k = 0; k < 2; ++k) {
    const Direction& direction = words.directions[k];
    const std::string name = "EI" + direction.bending;
    columns.push_back(direction.stiffness);
    factors[k] = import.derive(deck, direction.factor, "multiplies " + name + " of all sections");
    std::string meaning = name + ", times " + direction.factor;
    if (!direction.tuners.empty()) {
      factors[k] *= deck.number(direction.tuners[0]);
      meaning += " " + direction.tuners[0];
    }
    meanings.emplace_back(direction.stiffness, meaning);
  }
  if (!words.twist.empty()) {
    columns.push_back(words.twist);
    meanings.emplace_back(words.twist, "twist_deg");
  }
  const double mass_factor =
      import.derive(deck, words.mass_factor, "multiplies the mass of all sections");
  const DeckTable table =
      deck.table(columns, has_count ? static_cast<int>(count) : -1, words.count);
  check_grid(import, deck, table, words.place);
  if (!import.errors.empty()) return;
  say_columns(import, deck, table, meanings);

  const std::vector<double>& grid = table.columns[0];
  const auto scaled = [&](std::size_t column, double factor) {
    Curve curve{grid, table.columns[column]};
    for (double& value : curve.values) value *= factor;
    return curve;
  };
  const Curve mass = scaled(1, mass_factor);
  const std::array<Curve, 2> stiffness{scaled(2, factors[0]), scaled(3, factors[1])};
  const Curve twist = words.twist.empty() ? Curve{{0.0}, {0.0}} : scaled(4, 1.0);
  build_sections(import, deck, table, words, mass, stiffness,
                 words.twist.empty() ? nullptr : &twist, beam);
  for (std::size_t k = 0; k < 2 && import.errors.empty(); ++k) {
    const DampingPair pair = fit_damping(import, deck, words, words.directions[k], mass,
                                         stiffness[k], twist, beam.length);
    if (!words.directions[k].bends) continue;  // nothing to damp
    beam.damping(static_cast<Eigen::Index>(4 + k)) = pair.mu;
    beam.mass_damping(static_cast<Eigen::Index>(2 - k)) = pair.alpha;  // bending 2 moves along b3
  }
  import.note(words.block + ".damping", "by the ratios of the modes of each direction");
  import.note(words.block + ".mass_damping", "by the ratios of the modes of each direction");
  import.note(words.block + ".sections",
              "ElastoDyn has no axial, shear and torsional stiffness: rigid; no rotary inertia: 0");
  import.report_unused(deck);
}

}  // namespace

bool is_flexible(OpenfastImport& import, Deck& deck, const std::vector<std::string>& keys,
                 const std::string& target) {
  bool any = false;
  bool all = true;
  for (const std::string& key : keys) {
    const bool on = deck.flag(key);
    any = any || on;
    all = all && on;
  }
  for (const std::string& key : keys)
    import.say(deck, key, Fate::derived,
               !any  ? "False: " + target + " is rigid"
               : all ? "True: the beam bends, " + target
                     : "the modes are not all on: " + target + " is kept, with all of its modes");
  return any;
}

void read_elastodyn_tower(OpenfastImport& import, const std::string& path, bool bends_fore_aft,
                          bool bends_sideways) {
  const std::unique_ptr<Deck> deck = import.open(path);
  if (!deck) return;
  const BeamWords words{"tower",
                        "NTwInpSt",
                        "HtFract",
                        "",
                        "TMassDen",
                        "AdjTwMa",
                        {{{"TwFAStif",
                           "AdjFASt",
                           {"TwFAM1Sh", "TwFAM2Sh"},
                           {"TwrFADmp(1)", "TwrFADmp(2)"},
                           {"FAStTunr(1)", "FAStTunr(2)"},
                           "2",
                           bends_fore_aft},
                          {"TwSSStif",
                           "AdjSSSt",
                           {"TwSSM1Sh", "TwSSM2Sh"},
                           {"TwrSSDmp(1)", "TwrSSDmp(2)"},
                           {"SSStTunr(1)", "SSStTunr(2)"},
                           "3",
                           bends_sideways}}}};
  read_beam(import, *deck, words, import.turbine.tower);
}

bool read_elastodyn_blade(OpenfastImport& import, const std::string& path, bool speaks,
                          bool bends_flap, bool bends_edge, model::BeamDefinition& beam) {
  const std::unique_ptr<Deck> deck = import.open(path);
  if (!deck) return false;
  const std::size_t lines_before = import.report.size();
  const BeamWords words{
      "blades",
      "NBlInpSt",
      "BlFract",
      "StrcTwst",
      "BMassDen",
      "AdjBlMs",
      {{{"FlpStff",
         "AdjFlSt",
         {"BldFl1Sh", "BldFl2Sh"},
         {"BldFlDmp(1)", "BldFlDmp(2)"},
         {"FlStTunr(1)", "FlStTunr(2)"},
         "2",
         bends_flap},
        {"EdgStff", "AdjEdSt", {"BldEdgSh"}, {"BldEdDmp(1)"}, {}, "3", bends_edge}}}};
  read_beam(import, *deck, words, beam);
  if (!speaks) import.report.resize(lines_before);
  return import.errors.empty();
}

}  // namespace samara::decks
