#include "openfast_import.hpp"

#include <algorithm>
#include <initializer_list>

#include "samara/base/error.hpp"

namespace samara::decks {
namespace {

/// The reason why a key is ignored.
std::string reason(const std::string& key) {
  const auto starts = [&](const char* word) { return key.starts_with(word); };
  const auto is = [&](std::initializer_list<const char*> words) {
    return std::find(words.begin(), words.end(), key) != words.end();
  };
  if (starts("Ptfm")) return "the tower is clamped, there is no platform";
  if (is({"OoPDefl", "IPDefl", "TeetDefl", "TTDspFA", "TTDspSS"}))
    return "an initial state; the steady state is computed";
  if (is({"DTTorSpr", "DTTorDmp"})) return "shaft torsion is locked";
  if (is({"GBoxEff"})) return "losses of the gearbox are no part of a case";
  if (starts("PBrIner") || starts("BlPIner")) return "pitch is locked";
  if (is({"YawFrctMod", "M_CSmax", "M_FCSmax", "M_MCSmax", "M_CD", "M_FCD", "M_MCD", "sig_v",
          "sig_v2", "OmgCut"}))
    return "friction of the yaw bearing is no part of a case";
  if (starts("NcIMU") || is({"ShftGagL"})) return "the place of a sensor";
  if (is({"BldNodes", "TwrNodes", "quadrature", "refine"})) return "a case has a mesh of its own";
  if (is({"PreCone(3)", "BlPitch(3)", "TipMass(3)", "BldFile(3)", "PreCone(2)", "BlPitch(2)",
          "TipMass(2)", "BldFile(2)", "BDBldFile(1)", "BDBldFile(2)", "BDBldFile(3)"}))
    return "this rotor does not use it";
  if (starts("Comp") || (key.ends_with("File") && key != "OutFile"))
    return "belongs to a module that describes no structure of a case";
  return "a setting of the simulation or its output, no part of the structure";
}

}  // namespace

void OpenfastImport::say(Deck& deck, const std::string& key, Fate fate, const std::string& words) {
  report.push_back({deck.place_of(key), key, fate, words});
  deck.mark_used(key);
}

double OpenfastImport::take(Deck& deck, const std::string& key, const std::string& target) {
  const double value = deck.number(key);
  say(deck, key, Fate::taken, target);
  note(target, key);
  return value;
}

double OpenfastImport::derive(Deck& deck, const std::string& key, const std::string& words) {
  const double value = deck.number(key);
  say(deck, key, Fate::derived, words);
  return value;
}

void OpenfastImport::ignore(Deck& deck, const std::string& key, const std::string& why) {
  if (deck.has(key)) say(deck, key, Fate::ignored, why);
}

void OpenfastImport::require(bool holds, Deck& deck, const std::string& key,
                             const std::string& what) {
  if (!holds && deck.has(key)) errors.add(deck.place_of(key), key + ": " + what);
}

void OpenfastImport::report_unused(Deck& deck) {
  for (const Deck::FoundByPlace& found : deck.found_by_place()) {
    const std::string name = found.entry->key.empty() ? "a line without a name" : found.entry->key;
    const std::string words = "read as " + found.key + ", by its place between its neighbours";
    report.push_back({deck.place(found.entry->line), name, Fate::derived, words});
    warn(deck.place(found.entry->line), name + ": note: " + words);
  }
  for (const DeckEntry& entry : deck.entries())
    if (!entry.used && !entry.is_free_text)
      report.push_back({deck.place(entry.line), entry.key, Fate::ignored, reason(entry.key)});
}

std::unique_ptr<Deck> OpenfastImport::open(const std::string& path) {
  if (path.empty()) return nullptr;
  try {
    return std::make_unique<Deck>(path, errors);
  } catch (const InputError& error) {
    errors.add_message(error.what());
    return nullptr;
  }
}

}  // namespace samara::decks
