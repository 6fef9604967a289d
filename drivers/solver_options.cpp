#include "solver_options.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>
#include <vector>

#include "samara/base/error.hpp"

#include "table.hpp"

namespace samara::drivers {
namespace {

struct Prefix {
  const char* name;
  std::vector<std::string_view> objects;  ///< words after the prefix
  std::vector<std::string_view> commands;
  const char* words;
};

const std::vector<Prefix>& prefixes() {
  static const std::vector<Prefix> all{
      {"transient_",
       {"ts", "snes", "ksp", "pc", "mat"},
       {"transient"},
       "time integration: TS, and the SNES and KSP of a step"},
      {"static_", {"ksp", "pc", "mat"}, {"static"}, "linear systems of the equilibrium at rest"},
      {"modes_",
       {"eps", "ksp", "pc", "mat"},
       {"modes"},
       "eigenproblem of constant coefficients, and its linear systems"},
      {"floquet_",
       {"eps", "ksp", "pc", "mat"},
       {"floquet", "linearize"},
       "eigenproblem of the monodromy matrix, and the linear system of a step"},
      {"shooting_",
       {"ksp", "pc", "mat"},
       {"trim", "floquet", "modes", "linearize", "transient"},
       "linear system of a step of the steady state by shooting (trim.method)"},
      {"trim_",
       {"snes", "ksp", "pc", "mat"},
       {"trim", "floquet", "modes", "linearize", "transient"},
       "steady state by harmonic balance: SNES and its KSP"}};
  return all;
}

bool contains(const std::vector<std::string_view>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

std::string join(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : " ") + std::string(word);
  return text;
}

}  // namespace

std::string solver_options_text() {
  Table table;
  for (const char* title : {"prefix", "before", "command", "solver"})
    table.add_column(title, "", Align::left);
  for (const Prefix& prefix : prefixes())
    table.add_row({std::string("-") + prefix.name, join(prefix.objects), join(prefix.commands),
                   prefix.words});
  return "Options of PETSc and SLEPc are those of the solver with its prefix before them, as in "
         "-trim_snes_monitor:\n\n" +
         table.text() +
         "\nexamples\n"
         "  samara trim CASE.yaml -trim_snes_monitor -trim_snes_max_it 80\n"
         "  samara floquet CASE.yaml -floquet_eps_view -floquet_ksp_view\n"
         "  samara transient CASE.yaml -transient_ts_monitor -transient_snes_rtol 1e-9\n"
         "Without a prefix: -options_file FILE, -log_view, -options_left and others of PETSc "
         "itself.\n"
         "-samara_groups G (campbell): G groups of ranks take the points in turn, and the ranks of "
         "a "
         "group share a point: its mesh, steps or modes. Without it each rank is a group, where "
         "there "
         "are as many points.\n";
}

std::string prefixed_option(const std::string& option, const std::string& command) {
  const std::string name = option.substr(option.find_first_not_of('-'));
  const std::size_t end = name.find('_');
  if (end == std::string::npos) return "";
  const std::string_view object = std::string_view(name).substr(0, end);
  for (const Prefix& prefix : prefixes())
    if (contains(prefix.objects, object) && contains(prefix.commands, command))
      return std::string("-") + prefix.name + name;
  return "";
}

void refuse_unsupported_options(const std::string& options) {
  struct Refused {
    std::string_view ending;
    const char* reason;
  };
  constexpr std::array<Refused, 4> refused{
      {{"mat_type",
        "the types of matrices are fixed: baij with the blocks of the nodes, and for the trim no "
        "assembled matrix, or aij with options of its preconditioner"},
       {"vec_type", "the types of vectors are fixed"},
       {"snes_fd", "the tangents are exact; hint: -trim_snes_mf_operator applies differences"},
       {"snes_fd_color",
        "the tangents are exact; hint: -trim_snes_mf_operator applies differences"}}};
  std::istringstream words(options);
  for (std::string word; words >> word;) {
    if (word.front() != '-') continue;
    for (const Refused& one : refused)
      if (word.ends_with("_" + std::string(one.ending)) || word == "-" + std::string(one.ending))
        throw InputError(word + ": " + one.reason);
  }
}

}  // namespace samara::drivers
