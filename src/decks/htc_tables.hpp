// The tables of HAWC2: sections (.st), aerodynamic layout (.ae) and polars (.pc).
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "deck_text.hpp"

namespace samara::decks {

/// A table of sections: 19 columns, or 30 with a full stiffness matrix (`full`).
struct StTable {
  static constexpr std::size_t classic_columns = 19;
  static constexpr std::size_t full_columns = 30;

  std::string path;
  bool full = false;
  std::vector<std::vector<double>> rows;
  std::vector<int> lines;
  bool is_open = false;  ///< its last row is the end of a file without a final newline

  std::string place(std::size_t row) const { return path + ":" + std::to_string(lines[row]); }
};

/// The rows of a set and its subset, `set 1 2`. No rows, with an error, where they are not there.
StTable read_st(const std::string& path, int set, int subset, bool full, DeckErrors& errors);

struct AeRow {
  double r = 0.0;          ///< along the half-chord line [m]
  double chord = 0.0;      ///< [m]
  double thickness = 0.0;  ///< relative to the chord
  int set = 1;             ///< of the polars
  int line = 0;
};

std::vector<AeRow> read_ae(const std::string& path, int set, DeckErrors& errors);

struct PcPolar {
  double thickness = 0.0;      ///< relative to the chord
  std::vector<double> angles;  ///< [rad]
  std::vector<double> lift;
  std::vector<double> drag;
  std::vector<double> moment;
  int line = 0;
};

/// The polars of the sets that are asked for, by their numbers.
std::map<int, std::vector<PcPolar>> read_pc(const std::string& path, const std::vector<int>& sets,
                                            DeckErrors& errors);

}  // namespace samara::decks
