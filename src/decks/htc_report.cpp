#include "htc_report.hpp"

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "import_common.hpp"

namespace samara::decks {
namespace {

std::string reason(const std::string& block) {
  static const std::map<std::string, std::string> reasons{
      {"simulation", "a setting of the simulation"},
      {"output", "output of the simulation"},
      {"output_at_time", "output of the simulation"},
      {"dll", "a controller or a load of a library is no part of a case"},
      {"hydro", "water is no part of a case"},
      {"soil", "a foundation in the soil is no part of a case; tower.support states one"},
      {"force", "loads of a library are no part of a case"},
      {"hawcstab2", "settings of HAWCStab2"},
      {"moorings", "moorings are no part of a case"},
      {"mooring", "moorings are no part of a case"}};
  const auto found = reasons.find(block);
  return found == reasons.end() ? std::string() : found->second;
}

void report_operation(HtcImport& import, const HtcBlock& block) {
  const HtcCommand* command = block.find("operational_data_filename");
  if (command == nullptr || command->words.empty()) return;
  import.say("hawcstab2", *command, Fate::ignored,
             "hint: operation: {table: FILE} of the case reads it");
}

/// Commands of a block in use that no reader has used.
void report_unused(HtcImport& import, const HtcBlock& block, const std::string& name) {
  static const std::set<std::string> quiet{"body_output_file_name",
                                           "body_eigenanalysis_file_name",
                                           "beam_output_file_name",
                                           "struct_inertia_output_file_name",
                                           "structure_eigenanalysis_file_name",
                                           "constraint_output_file_name",
                                           "animation",
                                           "output_profile_coef_filename"};
  for (const HtcCommand& command : block.commands) {
    if (command.used) continue;
    const bool is_output = quiet.contains(command.name);
    import.say(name, command, Fate::ignored,
               is_output ? "output of the simulation" : "unknown to the importer");
    if (!is_output)
      import.warn(command.place,
                  clean_text(command.name) + ": note: left out, unknown to the importer");
  }
  for (const HtcBlock& part : block.blocks) {
    const std::string below = name + "." + clean_text(part.name);
    if (part.used) {
      if (name != "new_htc_structure.constraint") report_unused(import, part, below);
      continue;
    }
    import.say(part, below, Fate::ignored, "unknown to the importer");
    import.warn(part.place,
                "begin " + clean_text(part.name) + ": note: left out, unknown to the importer");
  }
}

}  // namespace

void report_files(HtcImport& import) {
  for (const HtcDeck::FoundFile& file : import.deck.found_files()) {
    import.report.push_back(
        {file.place, file.name, Fate::derived,
         "read from " + std::filesystem::path(file.path).filename().string() + ", relative to " +
             (file.is_above ? "the folder above that of the deck" : "the folder of the deck")});
    if (file.is_in_other_case)
      import.warn(file.place, file.name + ": note: read from " + file.path +
                                  ", whose name differs by upper and lower case");
  }
  for (const std::string& path : import.deck.without_exit())
    import.warn(path, "note: the file ends without exit; it may have been cut off");
}

void report_rest(HtcImport& import) {
  std::string left_out;
  const auto add = [&](const std::string& words) {
    left_out += (left_out.empty() ? "" : ", ") + words;
  };
  for (const HtcBlock& block : import.deck.root().blocks) {
    if (block.used) {
      report_unused(import, block, block.name);
      continue;
    }
    const std::string why = reason(block.name);
    import.say(block, block.name, Fate::ignored, why.empty() ? "unknown to the importer" : why);
    if (block.name == "dll") {
      for (const HtcBlock& part : block.blocks) {
        const HtcCommand* name = part.find("name");
        const std::string label =
            name == nullptr || name->words.empty() ? part.name : clean_text(name->words[0]);
        import.say(part, "dll." + label, Fate::ignored, why);
        add("the library " + label);
      }
      continue;
    }
    if (block.name == "hawcstab2") report_operation(import, block);
    if (why.empty() || block.name == "hydro" || block.name == "soil" || block.name == "force" ||
        block.name.starts_with("mooring"))
      add("begin " + clean_text(block.name));
  }
  for (const HtcCommand& command : import.deck.root().commands)
    if (!command.used) {
      import.say("", command, Fate::ignored, "unknown to the importer");
      add(clean_text(command.name));
    }
  if (!left_out.empty()) import.warn(import.deck.path(), "note: left out: " + left_out);
}

}  // namespace samara::decks
