#include "import_common.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "samara/base/error.hpp"
#include "samara/io/case.hpp"
#include "samara/io/whole_file.hpp"
#include "samara/io/yaml_tree.hpp"
#include "samara/model/definition.hpp"

namespace samara::decks {
namespace {

/// Distance of the two stations of a jump, relative to the length.
constexpr double jump_width = 1e-12;

/// Places closer than this are the same [of the length].
constexpr double same_place = 1e-9;

/// Largest difference of entries of a symmetric matrix that should be equal [of the diagonal].
constexpr double round_off = 1e-6;

/// Couplings up to this size are round-off [of the diagonal].
constexpr double no_coupling = 1e-14;

constexpr std::array<Eigen::Index, 3> source_axis = {2, 1, 0};
constexpr std::array<double, 3> source_sign = {1.0, -1.0, 1.0};

constexpr std::array<StatedQuantity, 9> quantities{
    {{"rotor-speed-rpm", "shaft.speed_rpm", 1},
     {"nacelle-mass", "nacelle.mass", 1},
     {"nacelle-center", "nacelle.center_of_mass", 3},
     {"nacelle-inertia", "nacelle.inertia", 3},
     {"yaw-mass", "tower.tip_mass", 1},
     {"generator-inertia", "shaft.generator.own_inertia", 1},
     {"hub-mass", "hub.mass", 1},
     {"hub-center", "hub.center_of_mass", 1},
     {"hub-inertia", "hub.inertia", 3}}};

}  // namespace

std::span<const StatedQuantity> stated_quantities() { return quantities; }

std::vector<Station> merge_grids(const std::vector<const std::vector<double>*>& grids) {
  std::vector<Station> stations;
  for (const auto* grid : grids)
    for (const double place : *grid)
      if (std::none_of(stations.begin(), stations.end(), [&](const Station& station) {
            return std::abs(station.place - place) <= same_place;
          }))
        stations.push_back({place, false});
  std::sort(stations.begin(), stations.end(),
            [](const Station& a, const Station& b) { return a.place < b.place; });
  std::vector<Station> all;
  for (const Station& station : stations) {
    all.push_back(station);
    const bool jumps = std::any_of(grids.begin(), grids.end(), [&](const auto* grid) {
      return std::count_if(grid->begin(), grid->end(), [&](double place) {
               return std::abs(place - station.place) <= same_place;
             }) > 1;
    });
    if (jumps && station.place < 1.0) all.push_back({station.place, true});
  }
  return all;
}

double interpolate(const Curve& curve, const Station& station) {
  const std::vector<double>& x = curve.grid;
  const std::vector<double>& y = curve.values;
  // The points of the grid that coincide with the station.
  std::size_t first = 0;
  while (first < x.size() && x[first] < station.place - same_place) ++first;
  std::size_t last = first;
  while (last < x.size() && x[last] <= station.place + same_place) ++last;
  if (last > first) return station.behind ? y[last - 1] : y[first];
  if (first == 0) return y.front();
  if (first == x.size()) return y.back();
  const double part = (station.place - x[first - 1]) / (x[first] - x[first - 1]);
  return y[first - 1] + part * (y[first] - y[first - 1]);
}

double place_of(const Station& station) {
  return station.behind ? station.place + jump_width : station.place;
}

Matrix6 turn_to_section_axes(const Matrix6& matrix) {
  Matrix6 turned;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j) {
      const auto a = static_cast<std::size_t>(i % 3);
      const auto b = static_cast<std::size_t>(j % 3);
      turned(i, j) = source_sign[a] * source_sign[b] *
                     matrix(3 * (i / 3) + source_axis[a], 3 * (j / 3) + source_axis[b]);
    }
  return turned;
}

Vector3 turn_to_section_axes(const Vector3& vector) { return {vector(2), -vector(1), vector(0)}; }

Vector6 turn_damping(const Vector6& mu) {
  Vector6 turned;
  turned << mu(2), mu(1), mu(0), mu(5), mu(4), mu(3);
  return turned;
}

double symmetrize(Matrix6& matrix) {
  double furthest = 0.0;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double difference = std::abs(matrix(i, j) - matrix(j, i));
      const double scale = std::sqrt(std::abs(matrix(i, i) * matrix(j, j)));
      if (difference == 0.0) continue;
      if (!(difference <= round_off * scale)) return 0.0;
      furthest = std::max(furthest, difference / scale);
    }
  matrix = (0.5 * (matrix + matrix.transpose())).eval();
  return furthest;
}

Matrix6 build_mass_matrix(double mass, const Vector3& inertia) {
  Matrix6 matrix = Matrix6::Zero();
  matrix.diagonal() << mass, mass, mass, inertia(0), inertia(1), inertia(2);
  return matrix;
}

void check_sections(const model::BeamDefinition& beam, const std::string& what,
                    const std::vector<std::string>& places, DeckErrors& errors) {
  struct Fault {
    std::size_t first;
    std::string words;
    std::size_t count;
  };
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < beam.sections.size(); ++i) {
    const std::string words = model::find_section_fault(beam.sections[i]);
    if (words.empty()) continue;
    const auto known = std::find_if(faults.begin(), faults.end(),
                                    [&](const Fault& fault) { return fault.words == words; });
    if (known == faults.end())
      faults.push_back({i, words, 1});
    else
      ++known->count;
  }
  for (const Fault& fault : faults)
    errors.add(places[std::min(fault.first, places.size() - 1)],
               what + ", section at " + rounded(beam.sections[fault.first].at) + " of the length" +
                   (fault.count > 1 ? " and " + std::to_string(fault.count - 1) + " more"
                                    : std::string()) +
                   ": " + fault.words);
}

void drop_round_off(Matrix6& matrix) {
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      if (i != j &&
          std::abs(matrix(i, j)) <= no_coupling * std::sqrt(std::abs(matrix(i, i) * matrix(j, j))))
        matrix(i, j) = 0.0;
}

BeamMass integrate_mass(const model::BeamDefinition& beam, double length) {
  BeamMass total;
  const auto add = [&](double a, double b, double m, double n) {  // linear from m to n
    const double h = (b - a) * length;
    total.mass += 0.5 * h * (m + n);
    total.moment += h * (a * length * 0.5 * (m + n) + h * (m / 6.0 + n / 3.0));
  };
  const std::vector<model::SectionDefinition>& s = beam.sections;
  if (s.empty()) return total;
  add(0.0, s.front().at, s.front().mass(0, 0), s.front().mass(0, 0));
  for (std::size_t i = 1; i < s.size(); ++i)
    add(s[i - 1].at, s[i].at, s[i - 1].mass(0, 0), s[i].mass(0, 0));
  add(s.back().at, 1.0, s.back().mass(0, 0), s.back().mass(0, 0));
  return total;
}

void check_import(const Import& import) {
  try {
    io::parse_case("the imported case", import.text, {});
  } catch (const InputError& error) {
    std::string words = error.what();
    const std::size_t end = words.find('\n');
    const auto more = std::count(words.begin(), words.end(), '\n');
    if (end != std::string::npos)
      words = words.substr(0, end) + " (and " + std::to_string(more) + " more)";
    throw InputError("the deck makes no valid case: " + words);
  }
}

std::string clean_text(const std::string& text) {
  std::string clean;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    clean += byte < 0x20 ? ' ' : byte < 0x7f ? c : '?';
  }
  while (!clean.empty() && clean.back() == ' ') clean.pop_back();
  return clean;
}

void require_case_path(const std::string& path) {
  if (!io::require_writable(path)) return;
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  bool is_case = false;
  try {
    is_case = io::parse_yaml(text).find("samara") != nullptr;
  } catch (const io::YamlError&) {
    is_case = false;
  }
  if (!is_case)
    throw InputError(path +
                     ": exists and is no case of samara, it would be lost; hint: -o gives the "
                     "case another name");
}

void write_case(const std::string& path, const Import& import) {
  io::write_whole_file(path, import.text);
}

}  // namespace samara::decks
