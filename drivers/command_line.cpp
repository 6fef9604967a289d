#include "command_line.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>

#include "samara/base/error.hpp"
#include "samara/base/version.hpp"
#include "samara/base/words.hpp"
#include "samara/io/whole_file.hpp"

namespace samara::drivers {
namespace {

std::vector<std::string> names_of(std::span<const Command> commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.emplace_back(command.name);
  return names;
}

bool is_safe(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("-_=./:,+@%").find(c) != std::string_view::npos;
}

/// `word` quoted so that a shell reads it as one word.
std::string quote(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_safe)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

bool is_number(const std::string& word) {
  const std::size_t digit = word.find_first_not_of("+-.");
  return digit != std::string::npos && std::isdigit(static_cast<unsigned char>(word[digit])) != 0;
}

/// PETSc's rule: a word that starts with a dash is an option, unless it is a negative number.
bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && !is_number(word);
}

class Parser {
 public:
  Parser(const std::vector<std::string>& arguments, std::span<const Command> commands)
      : arguments_(arguments), commands_(commands) {}

  CommandLine run() {
    line_.text = "samara";
    for (const std::string& argument : arguments_) line_.text += " " + quote(argument);
    while (next_ < arguments_.size()) take(arguments_[next_++]);
    if (line_.request == Request::run) require_operands();
    if (line_.request == Request::run && line_.command->print != nullptr)
      line_.request = Request::print;
    return line_;
  }

 private:
  void take(const std::string& word) {
    if (word.starts_with("--"))
      take_own(word);
    else if (word == "-h")
      line_.request = Request::help;
    else if (word == "-o")
      set_once(line_.result_path, "-o", value_of("-o", "a path, e.g. -o result.h5", {}));
    else if (is_option(word))
      take_petsc(word);
    else
      take_operand(word);
  }

  void take_own(const std::string& word) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    std::optional<std::string> value;
    if (equals != std::string::npos) value = word.substr(equals + 1);
    if (word == "--help")
      line_.request = Request::help;
    else if (word == "--help-options")
      line_.request = Request::solver_options;
    else if (word == "--version")
      line_.request = Request::version;
    else if (name == "--set")
      line_.settings.push_back(value_of(name, "key=value, e.g. --set blades.elements=8", value));
    else if (word == "--tower-only")
      take_import(name).tower_only = true;
    else if (name == "--mu-order")
      take_import(name).mu_order =
          mu_order_of(value_of(name, "beamdyn or hawc2, e.g. --mu-order hawc2", value));
    else if (const decks::StatedQuantity* quantity = find_quantity(name))
      take_quantity(*quantity, name, value);
    else if (word == "--report")
      line_.report = true;
    else if (word == "--all")
      line_.all_modes = true;
    else if (word == "--air")
      line_.air_part = true;
    else if (word == "--parked")
      line_.parked = true;
    else if (name == "--first")
      line_.first_modes =
          number_of(name, value_of(name, "a number of modes, e.g. --first 10", value));
    else if (name == "--sensitivity")
      set_once(line_.sensitivity, name,
               value_of(name, "keys of the case, e.g. --sensitivity blades.damping", value));
    else if (name == "--restart")
      set_once(line_.restart_path, name,
               value_of(name, "a result to go on from, e.g. --restart run.h5", value));
    else if (name == "--sweep")
      line_.sweep.push_back(
          value_of(name, "a key and its values, e.g. --sweep shaft.speed_rpm=0:14:0.5", value));
    else if (name == "--bands")
      line_.bands =
          number_of(name, value_of(name, "a number of crossings, e.g. --bands 20", value), 0);
    else if (name == "--csv")
      set_once(line_.csv_path, name, value_of(name, "a path, e.g. --csv modes.csv", value));
    else
      throw InputError("unknown option " + word + unknown_option_words(name));
  }

  decks::ImportOptions& take_import(const std::string& name) {
    if (line_.import_option.empty()) line_.import_option = name;
    if (name == "--rotor-speed-rpm")
      line_.speed_option = name;
    else if (name != "--tower-only")
      line_.windio_option = name;
    return line_.import;
  }

  static decks::MuOrder mu_order_of(const std::string& word) {
    if (word == "beamdyn") return decks::MuOrder::beamdyn;
    if (word == "hawc2") return decks::MuOrder::hawc2;
    throw InputError("--mu-order: expected beamdyn or hawc2, got " + quote(word) +
                     suggest(word, {"beamdyn", "hawc2"}));
  }

  static const decks::StatedQuantity* find_quantity(const std::string& name) {
    for (const decks::StatedQuantity& quantity : decks::stated_quantities())
      if (name == std::string("--") + quantity.option) return &quantity;
    return nullptr;
  }

  void take_quantity(const decks::StatedQuantity& quantity, const std::string& name,
                     const std::optional<std::string>& value) {
    const std::string expected =
        quantity.count == 1 ? "a number" : std::to_string(quantity.count) + " numbers, e.g. 0,1,2";
    const std::string words = value_of(name, expected, value);
    std::vector<double>& numbers = take_import(name).stated[quantity.key];
    if (!numbers.empty()) throw InputError(name + " is given twice; leave one of them out");
    std::istringstream stream(words);
    for (std::string word; std::getline(stream, word, ',');) {
      double number = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(number))
        throw InputError(name + " needs " + expected + ", got " + quote(words));
      numbers.push_back(number);
    }
    if (numbers.size() != quantity.count || words.ends_with(','))
      throw InputError(name + " needs " + expected + ", got " + quote(words));
  }

  static std::string unknown_option_words(const std::string& name) {
    std::vector<std::string> known{"--set",          "--csv",    "--all",     "--air",
                                   "--first",        "--parked", "--restart", "--mu-order",
                                   "--report",       "--help",   "--version", "--tower-only",
                                   "--help-options", "--sweep",  "--bands"};
    for (const decks::StatedQuantity& quantity : decks::stated_quantities())
      known.push_back(std::string("--") + quantity.option);
    const std::string suggestion = suggest(name, known);
    return suggestion.empty() ? "; hint: samara --help; options of PETSc have one dash"
                              : suggestion;
  }

  std::string value_of(const std::string& name, const std::string& expected,
                       const std::optional<std::string>& value) {
    if (value && !value->empty()) return *value;
    if (value || next_ == arguments_.size() || arguments_[next_].empty() ||
        is_option(arguments_[next_]))
      throw InputError(name + " needs " + expected);
    return arguments_[next_++];
  }

  static int number_of(const std::string& name, const std::string& word, int least = 1) {
    constexpr std::size_t most_digits = 6;
    const bool is_count =
        word.size() <= most_digits &&
        std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    const int number = is_count && !word.empty() ? std::stoi(word) : -1;
    if (number < least)
      throw InputError(name + ": expected a whole number from " + std::to_string(least) +
                       " to 999999, got " + quote(word));
    return number;
  }

  static void set_once(std::string& target, const std::string& name, const std::string& value) {
    if (!target.empty()) throw InputError(name + " is given twice; leave one of them out");
    target = value;
  }

  void take_petsc(const std::string& word) {
    if (word == "-set" || word == "-csv")  // PETSc would report only at the end that it is unused
      throw InputError("unknown option " + word + "; did you mean \"-" + word + "\"?");
    line_.petsc_options.push_back(word);
    if (next_ == arguments_.size() || is_option(arguments_[next_])) return;
    line_.petsc_options.push_back(arguments_[next_++]);
  }

  void take_operand(const std::string& word) {
    if (line_.command == nullptr) {
      const auto found = std::find_if(commands_.begin(), commands_.end(),
                                      [&](const Command& c) { return c.name == word; });
      if (found == commands_.end()) throw InputError(unknown_command(word));
      if (found->hand_over != nullptr && found->hands_over == nullptr)
        throw InputError(std::string("samara ") + found->name +
                         ": the command comes first; hint: samara " + found->name + " --help");
      line_.command = &*found;
    } else if (line_.command->formats != nullptr && line_.format.empty()) {
      require_format(word);
      line_.format = word;
    } else if (line_.command->print != nullptr) {
      throw InputError("unexpected argument \"" + word + "\": samara " + line_.command->name +
                       " takes none");
    } else if (line_.case_path.empty() && !word.empty()) {
      line_.case_path = word;
    } else if (static_cast<int>(line_.more_results.size()) + 1 < line_.command->most_results &&
               !word.empty()) {
      line_.more_results.push_back(word);
    } else {
      throw InputError("unexpected argument \"" + word + "\": the " + operand_word() + " is " +
                       line_.case_path + ", one per run; hint: samara " +
                       std::string(line_.command->name) + " --help");
    }
  }

  const char* operand_word() const {
    if (line_.command->most_results > 0) return "result";
    return line_.command->formats == nullptr ? "case" : "deck";
  }

  void require_format(const std::string& word) const {
    std::vector<std::string> formats;
    std::istringstream words(line_.command->formats);
    for (std::string format; std::getline(words, format, '|');) formats.push_back(format);
    if (std::find(formats.begin(), formats.end(), word) != formats.end()) return;
    const std::string suggestion = suggest(word, formats);
    throw InputError(
        "unknown format \"" + word + "\"" +
        (suggestion.empty() ? "; hint: the formats are " + join(formats, ", ") : suggestion));
  }

  std::string unknown_command(const std::string& word) const {
    const std::string suggestion = suggest(word, names_of(commands_));
    return "unknown command \"" + word + "\"" +
           (suggestion.empty() ? "; hint: the commands are " + join(names_of(commands_), ", ")
                               : suggestion);
  }

  void require_operands() const {
    if (line_.command == nullptr)
      throw InputError("missing command; hint: the commands are " +
                       join(names_of(commands_), ", ") + "; samara --help explains them");
    const std::string name = line_.command->name;
    if (line_.command->print != nullptr) {
      if (arguments_.size() > 1) throw InputError("samara " + name + " takes no options");
      return;
    }
    if (line_.command->formats != nullptr) {
      require_deck(name);
      return;
    }
    if (!line_.import_option.empty() || line_.report)
      throw InputError((line_.report ? "--report" : line_.import_option) + ": samara " + name +
                       " does not use it, samara import does");
    if (line_.command->most_results > 0)
      require_result(name);
    else if (line_.case_path.empty()) {
      std::string hint = "samara " + name + " --help shows an example";
      for (std::size_t i = 1; i < line_.petsc_options.size(); ++i)
        if (line_.petsc_options[i].find(".y") != std::string::npos)
          hint = line_.petsc_options[i] + " was taken for the value of " +
                 line_.petsc_options[i - 1] + ", the case comes before the options of PETSc";
      throw InputError("missing case file: samara " + name + " CASE.yaml; hint: " + hint);
    }
    if (line_.all_modes && !line_.command->lists_modes)
      throw InputError("--all: samara " + name + " lists no modes; modes and floquet do");
    if (line_.air_part && !line_.command->lists_modes)
      throw InputError("--air: samara " + name + " lists no modes; modes and floquet do");
    if (line_.first_modes > 0 && !line_.command->lists_modes)
      throw InputError("--first: samara " + name + " lists no modes; modes and floquet do");
    if (!line_.sensitivity.empty() && name != "floquet")
      throw InputError("--sensitivity: samara " + name + " does not use it, samara floquet does");
    if (line_.parked && name != "modes")
      throw InputError("--parked: samara " + name +
                       " does not use it, samara modes does; hint: --set shaft.speed=0");
    if (!line_.restart_path.empty() && name != "transient")
      throw InputError("--restart: samara " + name + " does not use it, samara transient does");
    if (!line_.sweep.empty() && !line_.command->has_sweep)
      throw InputError("--sweep: samara " + name + " has no sweep, samara campbell has one");
    if (line_.bands && !line_.command->has_sweep)
      throw InputError("--bands: samara " + name + " does not use it, samara campbell does");
    if (!line_.csv_path.empty() && !line_.command->has_csv)
      throw InputError(
          "--csv: samara " + name + " has no table to write" +
          (name == "transient" ? "; hint: samara export makes one of the result" : ""));
    if (!line_.csv_path.empty() && io::is_same_file(line_.csv_path, line_.result_path))
      throw InputError("-o and --csv name the same file; give each its own");
  }

  void require_result(const std::string& name) const {
    if (line_.case_path.empty())
      throw InputError("missing result: samara " + name + " RESULT.h5; hint: samara " + name +
                       " --help shows an example");
    if (line_.command->run != nullptr) return;
    if (!line_.settings.empty())
      throw InputError("--set: samara " + name +
                       " does not use it; hint: it applies to the commands that read the case");
    if (!line_.petsc_options.empty())
      throw InputError(line_.petsc_options[0] + ": samara " + name + " solves nothing");
    if (line_.result_path.empty())
      throw InputError("missing -o FILE; hint: -o time_series.h5, .csv, .out or .outb");
  }

  void require_deck(const std::string& name) const {
    const std::string usage =
        "samara " + name + " " + line_.command->formats + " DECK -o CASE.yaml";
    if (line_.format.empty()) throw InputError("missing format of the deck: " + usage);
    if (line_.case_path.empty()) throw InputError("missing deck: " + usage);
    if (!line_.settings.empty() || !line_.csv_path.empty())
      throw InputError(std::string(line_.csv_path.empty() ? "--set" : "--csv") + ": samara " +
                       name +
                       " does not use it; hint: it applies to the commands that read the case");
    if (!line_.petsc_options.empty())
      throw InputError(line_.petsc_options[0] + ": samara " + name + " solves nothing");
    if (line_.format != "windio" && !line_.windio_option.empty())
      throw InputError(line_.windio_option + ": the decks of " + line_.format +
                       " contain it; it applies to windio");
    if (line_.format == "openfast" && !line_.speed_option.empty())
      throw InputError(line_.speed_option +
                       ": the decks of openfast contain it; it applies to windio and hawc2");
    if (line_.result_path.empty() && !line_.report)
      throw InputError(
          "missing -o CASE.yaml; hint: --report alone prints the report and writes no case");
  }

  const std::vector<std::string>& arguments_;
  std::span<const Command> commands_;
  std::size_t next_ = 0;
  CommandLine line_;
};

constexpr char import_lines[] =
    R"(options
  -o CASE.yaml      the case file; only a case of samara is ever overwritten
  --report          makes -o optional; without -o only the report is printed
  --tower-only      leaves out the parts below the tower, which is clamped at its foot
  --mu-order ORDER  beamdyn or hawc2: the order of structural_damping.mu (windio)
  --nacelle-mass M  gives a value that a deck lacks, or replaces it (windio), in the units and axes
                    of the case; also --nacelle-center Y1,Y2,Y3 --nacelle-inertia I1,I2,I3
                    --yaw-mass --hub-mass --hub-center --hub-inertia I1,I2,I3
                    --generator-inertia
  --rotor-speed-rpm N  the speed of the rotor (windio, hawc2)
  --help            this text
)";

constexpr char export_lines[] =
    R"(options
  -o FILE           the time series, in the format of its ending, or NAME.pvd.
                    Only a file that samara wrote is overwritten
  --format vtk      the motion for ParaView, with further options
  --help            this text
)";

constexpr char load_lines[] =
    R"(options
  --set key=value   channels, from, until, exponents, equivalent_frequency, harmonics, bins,
                    goodman, azimuths, hours, equivalent_cycles; may be repeated
  -o LOADS.h5       all results of the evaluation; without it nothing is written
  --csv FILE.csv    statistics and equivalent loads as comma-separated values, too
  --help            this text
)";

constexpr char option_lines[] =
    R"(options
  --set key=value   replaces or adds a key of the case before it is checked; may be repeated
  -o RESULT.h5      the result; without it the case's name with .h5, in the current folder.
                    Only a file that samara wrote is ever overwritten
  --csv FILE.csv    the table as comma-separated values, too
  --all             lists unresolved modes, too (modes, floquet)
  --air             part of the air in the damping, by the modes under constant air loads (modes,
                    floquet; takes about twice the time)
  --first N         lists the first N modes; the verdict counts all (modes, floquet)
  --sensitivity KEYS derivatives of the listed modes to numbers of the case (floquet): keys
                    separated by commas, * for all items: tower.sections.*.mass
  --parked          the rotor stands still, as with --set shaft.speed=0 (modes)
  --restart FILE.h5 continues from the last checkpoint of a result (transient)
  --sweep KEY=VALUES the values of a key (campbell): FROM:TO:STEP, or V1,V2,...; given twice, a
                    map over two keys
  --bands N         searches bands of instability between the points at N crossings of
                    frequencies at most (campbell; without it at half as many as points)
  --help            this text; samara <command> --help shows an example
  --version         versions of samara and of its libraries
  --help-options    the prefixes of options of PETSc and SLEPc
  -name [value]     anything else with one dash goes to PETSc and SLEPc
)";

std::string padded(const std::string& word, std::size_t width) {
  return word + std::string(width - std::min(width, word.size()), ' ');
}

}  // namespace

std::string join(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

CommandLine parse_command_line(const std::vector<std::string>& arguments,
                               std::span<const Command> commands) {
  return Parser(arguments, commands).run();
}

std::string help_text(const CommandLine& line, std::span<const Command> commands) {
  const std::string options = " CASE.yaml [options]";
  if (line.command != nullptr) {
    const Command& command = *line.command;
    if (command.formats != nullptr)
      return std::string("samara ") + command.name + " " + command.formats +
             " DECK -o CASE.yaml [options]\n\n" + command.description + "\nexample\n  samara " +
             command.name + " " + command.example + "\n\n" + import_lines;
    if (command.most_results > 0)
      return std::string("samara ") + command.name + " RESULT.h5" +
             (command.run == nullptr ? " -o FILE" : " [RESULT.h5 ...] [options]") + "\n\n" +
             command.description + "\nexample\n  samara " + command.name + " " + command.example +
             "\n\n" + (command.run == nullptr ? export_lines : load_lines);
    if (command.print != nullptr)
      return std::string("samara ") + command.name + "\n\n" + command.description +
             "\nexample\n  samara " + command.name + " " + command.example + "\n";
    return std::string("samara ") + command.name + options + "\n\n" + command.description +
           "\nexample\n  samara " + command.name + " " + command.example + "\n\n" + option_lines;
  }
  std::string text = "samara " + std::string(version) +
                     ": rotor dynamics of horizontal-axis wind turbines\n\nusage\n" +
                     "  samara <command>" + options +
                     "\n  samara new KIND NAME\n"
                     "  samara import openfast|windio|hawc2 DECK -o CASE.yaml\n"
                     "  samara export RESULT.h5 -o FILE\n"
                     "  samara loads RESULT.h5 [options]\n"
                     "  samara plot RESULT.h5 [KIND ...] [-o FILE]\n"
                     "  samara report RESULT.h5 [RESULT.h5 ...] -o report.html\n"
                     "  mpirun -n 4 samara <command>" +
                     options + "\n\ncommands\n";
  for (const Command& command : commands)
    text += "  " + padded(command.name, 10) + command.summary + "\n";
  return text + "\nexample\n  samara floquet inputs/lee2002/baseline.yaml --set shaft.speed=5\n\n" +
         option_lines +
         R"(
exit codes
  0  done
  1  the environment failed, or samara has a defect
  2  an input error: the case, an option, a path
  3  an iteration did not converge, or there is no verdict on stability
  130 ended by Ctrl-C

The keys of a case are explained in docs/case_file.md.
)";
}

}  // namespace samara::drivers
