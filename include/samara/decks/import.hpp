// Reads turbines in the formats of other programs and states them as case files (docs/import.md).
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

namespace samara::decks {

/// Fate of a key of the deck.
enum class Fate {
  taken,    ///< the case has the value as it is, or in another unit or axis
  derived,  ///< the case has values that follow from it
  ignored   ///< the case has nothing of it
};

struct ImportLine {
  std::string place;  ///< file, and line where there is one
  std::string key;    ///< as the deck names it
  Fate fate = Fate::taken;
  std::string words;  ///< where the case has it, or why the case does not have it
};

/// A quantity that a deck may lack and an option of the command line can state.
struct StatedQuantity {
  const char* option;  ///< without the dashes
  const char* key;     ///< of the case, in whose units and axes it counts
  std::size_t count;   ///< of numbers
};
std::span<const StatedQuantity> stated_quantities();

/// Order of the six structural damping coefficients mu of windIO.
enum class MuOrder {
  automatic,  ///< as the deck's matrices, unless the pattern of the numbers is HAWC2's
  beamdyn,    ///< shear x, shear y, axial, bending x, bending y, torsion
  hawc2       ///< HAWC2's Kx (bending about y), Ky (about x), Kz (torsion), three zeros
};

struct ImportOptions {
  bool tower_only = false;  ///< leave out the structure below the tower and clamp its foot
  MuOrder mu_order = MuOrder::automatic;
  std::map<std::string, std::vector<double>> stated{};  ///< quantities of the case, by their keys
};

struct Import {
  std::string text;  ///< a complete, commented case file
  std::vector<ImportLine> report;
  std::vector<std::string> warnings;  ///< facts that the user would not expect, `place: words`
};

/// Reads the main file of OpenFAST (8.16 to 5.0) and the files of ElastoDyn, BeamDyn, AeroDyn and
/// InflowWind that it names.
/// @throws InputError with every error found, one a line, `file:line: key: fault`.
Import import_openfast(const std::string& path, const ImportOptions& options);

/// Reads a turbine of windIO 1.0 or 2.0.
/// @throws InputError as above
Import import_windio(const std::string& path, const ImportOptions& options);

/// Reads a deck of HAWC2: the main file (.htc), the files in which it continues, and the tables of
/// sections (.st), aerodynamic layout (.ae) and polars (.pc) that it names.
/// @throws InputError as above
Import import_hawc2(const std::string& path, const ImportOptions& options);

/// @throws InputError where a case cannot be written at `path`: no such folder, no permission, or a
/// file there that is no case file of this program.
void require_case_path(const std::string& path);

/// Writes the case as a whole or not at all.
void write_case(const std::string& path, const Import& import);

}  // namespace samara::decks
