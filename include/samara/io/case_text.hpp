// Writes a turbine as the text of a case file.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "samara/fields/field.hpp"
#include "samara/model/definition.hpp"
#include "samara/model/operating_points.hpp"

namespace samara::io {

struct CaseComments {
  std::vector<std::string> head;            ///< lines at the top of the file
  std::map<std::string, std::string> keys;  ///< by path of the key: "shaft.overhang"
};

/// Writes the keys that have a comment, are compulsory or differ from their default. Numbers read
/// back as the same doubles.
std::string write_case_text(const model::TurbineDefinition& turbine, const CaseComments& comments,
                            const model::OperatingPointsDefinition& operation = {});

/// The shortest decimal that reads back as the same double.
std::string exact(double value);

/// The shortest decimal in `unit` that reads back as the value in SI; if there is none because of
/// round-off, the nearest one.
std::string exact_in(const fields::Unit& unit, double value);

}  // namespace samara::io
