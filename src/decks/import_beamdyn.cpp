#include "import_beamdyn.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "samara/model/definition.hpp"

#include "beamdyn_line.hpp"
#include "import_common.hpp"

namespace samara::decks {
namespace {

/// Tolerance of places along the blade, and of the root's coordinates relative to its length.
constexpr double same_place = 1e-9;

constexpr double most_twist = 180.0;  // deg

constexpr int most_rows = 100000;
constexpr int most_order = 100;

/// Sections as the file states them, at fractions of the length.
struct Stations {
  std::vector<double> grid;
  std::vector<Matrix6> stiffness;
  std::vector<Matrix6> mass;
  std::vector<int> lines;
};

class Reader {
 public:
  explicit Reader(OpenfastImport& import) : import_(import) {}

  bool run(const std::string& path, bool speaks, model::BeamDefinition& beam) {
    const std::unique_ptr<Deck> primary = import_.open(path);
    if (!primary) return false;
    Deck& deck = *primary;
    deck.set_order({"member_total", "kp_total", "order_elem", "BldFile"});
    const std::size_t lines_before = import_.report.size();
    const std::vector<KeyPoint> points = read_key_points(deck);
    const std::vector<int> members = read_members(deck, static_cast<int>(points.size()));
    const int order = deck.integer("order_elem", 1, most_order);
    const std::string name = deck.file("BldFile");
    import_.say(deck, "BldFile", Fate::taken, "read");
    for (const char* key : {"UsePitchAct", "PitchJ", "PitchK", "PitchC"})
      import_.ignore(deck, key, "pitch is locked");
    const std::unique_ptr<Deck> body = import_.open(name);
    if (!body || !import_.errors.empty()) return false;

    const BeamdynLine line(points, members, order);
    if (line.swings_out()) {
      import_.errors.add(deck.place_of("kp_total"),
                         "kp_zr: the polynomials over z through the key points swing out to a "
                         "length of " +
                             rounded(line.length()) + " m; hint: z must rise evenly");
      return false;
    }
    beam.length = line.length();
    if (!line.is_straight()) beam.reference_line = line.points();
    import_.note("blades.length", "the last key point");
    import_.note("blades.reference_line",
                 "through BeamDyn's polynomials over z of the key points, [z, -y, x]");
    import_.say(deck, "order_elem", Fate::derived,
                "the degree of the polynomials is min(order_elem, key points - 1, 6)");
    read_body(*body, line, beam);
    if (!import_.errors.empty()) return false;
    import_.report_unused(deck);
    import_.report_unused(*body);
    if (!speaks) import_.report.resize(lines_before);
    return true;
  }

 private:
  std::vector<KeyPoint> read_key_points(Deck& deck) {
    const int count = deck.has("kp_total") ? deck.integer("kp_total", 2, most_rows) : -1;
    if (count < 0) deck.number("kp_total");
    import_.say(deck, "kp_total", Fate::derived, "the number of key points");
    const DeckTable table =
        deck.table({"kp_xr", "kp_yr", "kp_zr", "initial_twist"}, count, "kp_total");
    std::vector<KeyPoint> points;
    for (std::size_t i = 0; i < table.lines.size(); ++i)
      points.push_back(
          {{table.columns[0][i], table.columns[1][i], table.columns[2][i]}, table.columns[3][i]});
    if (points.empty()) return points;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (std::abs(points[i].twist_deg) > most_twist)
        import_.errors.add(deck.place(table.lines[i]),
                           "initial_twist: expected an angle between -180 and 180 degrees, got " +
                               rounded(points[i].twist_deg));
    for (std::size_t i = 1; i < points.size(); ++i)
      if (!(points[i].position(2) > points[i - 1].position(2)))
        import_.errors.add(deck.place(table.lines[i]),
                           "kp_zr: expected more than the key point before has, " +
                               rounded(points[i - 1].position(2)));
    if (points[0].position.norm() > same_place * points.back().position.norm())
      import_.errors.add(deck.place(table.lines[0]), "the first key point must be 0, 0, 0");
    points[0].position.setZero();
    for (const auto& [column, words] :
         {std::pair<const char*, const char*>{"kp_xr", "b3"}, {"kp_yr", "-b2"}, {"kp_zr", "b1"}})
      import_.say_line(deck, table.line, column, Fate::derived,
                       std::string("the line along ") + words +
                           ", by a polynomial of each member as BeamDyn fits it");
    import_.say_line(deck, table.line, "initial_twist", Fate::derived,
                     "twist_deg of the sections, by the same polynomial");
    return points;
  }

  /// Numbers of key points of the members, which follow the line of kp_total.
  std::vector<int> read_members(Deck& deck, int points) {
    const int count = deck.integer("member_total", 1, most_rows);
    import_.say(deck, "member_total", Fate::derived,
                count == 1 ? "one polynomial" : "one polynomial for each member");
    if (count == 1) {
      const std::vector<std::vector<double>> row = deck.rows_behind("kp_total", 1);
      if (!row.empty() && row[0].size() == 2 && row[0][0] == 1.0 && row[0][1] != points)
        import_.errors.add(deck.place_of("kp_total"), "kp_total: " + std::to_string(points) +
                                                          ", the member behind it has " +
                                                          rounded(row[0][1]) + " key points");
      return {points};
    }
    std::vector<int> members;
    int sum = 1;
    for (const std::vector<double>& row : deck.rows_behind("kp_total", count)) {
      const bool is_whole =
          row.size() >= 2 && row[1] >= 2.0 && row[1] <= points && row[1] == std::floor(row[1]);
      if (!is_whole) break;
      members.push_back(static_cast<int>(row[1]));
      sum += members.back() - 1;
    }
    if (static_cast<int>(members.size()) != count || sum != points)
      import_.errors.add(deck.place_of("member_total"),
                         "member_total: behind the line of kp_total " + std::to_string(count) +
                             " lines state the members and their numbers of key points; members "
                             "share their ends and have kp_total points together");
    return members;
  }

  void read_body(Deck& deck, const BeamdynLine& line, model::BeamDefinition& beam) {
    deck.set_order({"station_total", "damp_type"});
    const int count = deck.has("station_total") ? deck.integer("station_total", 1, most_rows) : -1;
    if (count < 0) deck.number("station_total");
    import_.say(deck, "station_total", Fate::derived, "the number of stations");
    read_damping(deck, beam);
    import_.note("blades.sections", "matrices of BeamDyn, turned to b1 = z, b2 = -y, b3 = x");
    const int heading = deck.find_heading("DISTRIBUTED");
    if (heading == 0)
      import_.errors.add(deck.path(),
                         "missing heading \"DISTRIBUTED PROPERTIES\" above the stations");
    if (!import_.errors.empty()) return;
    Stations stations;
    if (!read_stations(deck, heading, count, stations)) return;
    build_sections(deck, line, stations, beam);
    import_.say_line(deck, heading, "stations", Fate::taken,
                     "sections: mass_matrix and stiffness_matrix, interpolated where the twist "
                     "needs more of them");
  }

  void read_damping(Deck& deck, model::BeamDefinition& beam) {
    // Older files call it damp_flag.
    const std::string key =
        !deck.has("damp_type") && deck.has("damp_flag") ? "damp_flag" : "damp_type";
    const int type = deck.integer(key, 0, 2);
    import_.say(deck, key, type == 1 ? Fate::taken : Fate::derived,
                type == 0   ? "0: no damping"
                : type == 1 ? "1: blades.damping"
                            : "2, modal damping, is not imported: blades.damping is 0");
    Vector6 mu = Vector6::Zero();
    if (type == 1) {
      const DeckTable table = deck.table({"mu1", "mu2", "mu3", "mu4", "mu5", "mu6"}, 1, key);
      if (!import_.errors.empty()) return;
      for (std::size_t i = 0; i < 6; ++i) {
        mu(static_cast<Eigen::Index>(i)) = table.columns[i][0];
        if (table.columns[i][0] < 0.0)
          import_.errors.add(deck.place(table.lines[0]),
                             table.names[i] + ": expected a number >= 0");
        constexpr std::array<const char*, 6> targets = {"shear 3",   "shear 2",   "axial",
                                                        "bending 3", "bending 2", "torsion"};
        import_.say_line(deck, table.line, table.names[i], Fate::taken,
                         std::string("blades.damping of ") + targets[i]);
      }
    }
    if (type == 2)
      import_.warn(deck.place_of(key),
                   key +
                       ": warning: modal damping (damp_type 2) is left out: the blades are "
                       "undamped; blades.damping of the case states their ratios");
    beam.damping = turn_damping(mu);
    import_.note("blades.damping", type == 1   ? "mu3, mu2, mu1, mu6, mu5, mu4 of BeamDyn"
                                   : type == 2 ? "BeamDyn's modal damping is not imported"
                                               : "damp_type 0");
  }

  void build_sections(Deck& deck, const BeamdynLine& line, Stations& stations,
                      model::BeamDefinition& beam) {
    std::vector<std::string> places;
    for (const BeamdynLine::Place& place : line.places(stations.grid)) {
      // The first station that is not before this place.
      const auto next = std::lower_bound(stations.grid.begin(), stations.grid.end() - 1,
                                         place.station - same_place);
      const auto row = static_cast<std::size_t>(next - stations.grid.begin());
      const std::size_t before = row == 0 ? 0 : row - 1;
      const double part = row == 0
                              ? 0.0
                              : std::min(1.0, (place.station - stations.grid[before]) /
                                                  (stations.grid[row] - stations.grid[before]));
      const auto between = [&](const std::vector<Matrix6>& matrices) {
        return turn_to_section_axes(
            Matrix6(matrices[before] + part * (matrices[row] - matrices[before])));
      };
      model::SectionDefinition section;
      section.at = std::min(1.0, place_of(Station{place.arc, place.jumps}));
      section.stiffness = between(stations.stiffness);
      section.mass = between(stations.mass);
      drop_round_off(section.stiffness);
      drop_round_off(section.mass);
      section.twist = fields::deg.to_si(place.twist_deg);
      places.push_back(deck.place(stations.lines[row]));
      beam.sections.push_back(section);
    }
    check_sections(beam, "blade", places, import_.errors);
  }

  bool read_stations(Deck& deck, int heading, int count, Stations& stations) {
    const std::vector<DeckRow> rows = deck.rows_after(heading);
    std::vector<double>& grid = stations.grid;
    double asymmetry = 0.0;
    std::size_t next = 0;
    while (next < rows.size() && import_.errors.empty()) {
      if (rows[next].numbers.size() != 1) {
        import_.errors.add(deck.place(rows[next].line),
                           "expected the place of a station, one number from 0 to 1, got " +
                               std::to_string(rows[next].numbers.size()) + " numbers");
        return false;
      }
      const double place = rows[next].numbers[0];
      stations.lines.push_back(rows[next].line);
      if (place < 0.0 || place > 1.0 + same_place || (!grid.empty() && !(place > grid.back())))
        import_.errors.add(deck.place(rows[next].line),
                           "expected a place from 0 to 1, beyond that of the station before, got " +
                               rounded(place));
      grid.push_back(std::min(place, 1.0));
      ++next;
      for (std::vector<Matrix6>* matrices : {&stations.stiffness, &stations.mass}) {
        const bool is_stiffness = matrices == &stations.stiffness;
        Matrix6 matrix = Matrix6::Zero();
        for (Eigen::Index i = 0; i < 6; ++i, ++next) {
          if (next == rows.size() || rows[next].numbers.size() != 6) {
            import_.errors.add(
                deck.place(next == rows.size() ? rows.back().line : rows[next].line),
                std::string("expected row ") + std::to_string(i + 1) + " of 6 numbers of the " +
                    (is_stiffness ? "stiffness" : "mass") + " matrix" +
                    (next == rows.size()
                         ? ", the file ends"
                         : ", got " + std::to_string(rows[next].numbers.size()) + " numbers"));
            return false;
          }
          for (Eigen::Index j = 0; j < 6; ++j)
            matrix(i, j) = rows[next].numbers[static_cast<std::size_t>(j)];
        }
        asymmetry = std::max(asymmetry, symmetrize(matrix));
        matrices->push_back(matrix);
      }
    }
    if (asymmetry > 0.0)
      import_.warn(deck.path(), "note: matrices that are not symmetric, by up to " +
                                    rounded(asymmetry, 2) +
                                    " of their diagonal, are replaced by their symmetric part");
    if (!rows.empty() && deck.ends_inside(rows.back().line))
      import_.errors.add(deck.place(rows.back().line),
                         "the file ends inside this line, perhaps in a number; hint: if it is "
                         "whole, end it with a new line");
    if (count >= 0 && static_cast<int>(stations.lines.size()) != count)
      import_.errors.add(deck.place_of("station_total"),
                         "station_total: " + std::to_string(count) + ", the file has " +
                             std::to_string(stations.lines.size()) + " stations");
    if (grid.empty()) import_.errors.add(deck.path(), "no station below the heading");
    if (!grid.empty() && grid.front() != 0.0)
      import_.errors.add(deck.place(stations.lines.front()), "the first station must be at 0");
    if (!grid.empty() && grid.back() < 1.0 - same_place)
      import_.errors.add(deck.place(stations.lines.back()), "the last station must be at 1");
    return import_.errors.empty();
  }

  OpenfastImport& import_;
};

}  // namespace

bool read_beamdyn(OpenfastImport& import, const std::string& path, bool speaks,
                  model::BeamDefinition& beam) {
  return Reader(import).run(path, speaks, beam);
}

}  // namespace samara::decks
