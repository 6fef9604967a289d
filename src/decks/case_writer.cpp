#include "case_writer.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace samara::decks {
namespace {

constexpr std::size_t comment_column = 44;

/// A text that YAML reads back as itself.
std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "\"";
}

std::string list(const std::vector<double>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) text += (i > 0 ? ", " : "") + exact(values[i]);
  return text + "]";
}

std::string list(const Vector3& v) { return list(std::vector<double>{v(0), v(1), v(2)}); }

bool has_couplings(const Matrix6& matrix) {
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      if (i != j && matrix(i, j) != 0.0) return true;
  return false;
}

class Writer {
 public:
  explicit Writer(const CaseDraft& draft) : draft_(draft) {}

  std::string run() {
    for (const std::string& line : draft_.head) text_ += line.empty() ? "#\n" : "# " + line + "\n";
    text_ += "\n";
    add(0, "samara", "1", "version of the case file");
    add(0, "title", quote(draft_.title));
    add("", 0, "gravity", exact(draft_.gravity), "m/s^2");
    if (draft_.has_tower) {
      text_ += "\ntower:\n";
      add_beam("tower", draft_.tower);
    }
    if (draft_.has_rotor) {
      add_nacelle();
      add_shaft();
      add_hub();
      add_blades();
    }
    return text_;
  }

 private:
  void add(std::size_t indent, const std::string& key, const std::string& value,
           const std::string& comment = "") {
    std::string line = std::string(indent, ' ') + key + ": " + value;
    if (!comment.empty()) {
      line += std::string(line.size() < comment_column ? comment_column - line.size() : 1, ' ');
      line += "# " + comment;
    }
    text_ += line + "\n";
  }

  /// The comment is the unit, and what the importer has noted of the key.
  void add(const std::string& block, std::size_t indent, const std::string& key,
           const std::string& value, const std::string& unit) {
    const auto note = draft_.notes.find(block.empty() ? key : block + "." + key);
    std::string comment = unit;
    if (note != draft_.notes.end()) comment += (comment.empty() ? "" : "; ") + note->second;
    add(indent, key, value, comment);
  }

  void add_matrix(const std::string& key, const Matrix6& matrix, const std::array<bool, 6>* rigid) {
    text_ += "      " + key + ":\n";
    for (Eigen::Index i = 0; i < 6; ++i) {
      text_ += "        - [";
      for (Eigen::Index j = 0; j < 6; ++j) {
        const bool is_rigid = rigid != nullptr && i == j && (*rigid)[static_cast<std::size_t>(i)];
        text_ += (j > 0 ? ", " : "") + (is_rigid ? "rigid" : exact(matrix(i, j)));
      }
      text_ += "]\n";
    }
  }

  void add_section(const DraftSection& section) {
    constexpr std::array<const char*, 6> names = {"EA", "GA2", "GA3", "GJ", "EI2", "EI3"};
    text_ += "    - at: " + exact(section.at) + "\n";
    if (has_couplings(section.mass)) {
      add_matrix("mass_matrix", section.mass, nullptr);
    } else {
      text_ += "      mass: " + exact(section.mass(0, 0)) + "\n";
      text_ += "      inertia: " +
               list(Vector3(section.mass(3, 3), section.mass(4, 4), section.mass(5, 5))) + "\n";
    }
    if (has_couplings(section.stiffness)) {
      add_matrix("stiffness_matrix", section.stiffness, &section.rigid);
    } else {
      text_ += "      stiffness: {";
      for (std::size_t i = 0; i < names.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        text_ += std::string(i > 0 ? ", " : "") + names[i] + ": " +
                 (section.rigid[i] ? "rigid" : exact(section.stiffness(k, k)));
      }
      text_ += "}\n";
    }
    if (section.twist_deg != 0.0) text_ += "      twist_deg: " + exact(section.twist_deg) + "\n";
  }

  void add_beam(const std::string& block, const DraftBeam& beam) {
    if (beam.reference_line.empty()) {
      add(block, 2, "length", exact(beam.length), "m");
    } else {
      const auto note = draft_.notes.find(block + ".reference_line");
      text_ += "  reference_line:";
      text_ += note == draft_.notes.end() ? "\n" : "  # " + note->second + "\n";
      for (const Vector3& point : beam.reference_line) text_ += "    - " + list(point) + "\n";
    }
    add(block, 2, "elements", std::to_string(beam.elements), "");
    add(block, 2, "order", std::to_string(beam.order), "Gauss points an element");
    add(block, 2, "damping",
        list(std::vector<double>(beam.damping.data(), beam.damping.data() + 6)), "s");
    if (!beam.mass_damping.isZero(0.0))
      add(block, 2, "mass_damping", list(beam.mass_damping), "1/s");
    add(block, 2, "tip_mass", exact(beam.tip_mass), "kg");
    const auto note = draft_.notes.find(block + ".sections");
    if (note != draft_.notes.end()) text_ += "  # " + note->second + "\n";
    text_ += "  sections:\n";
    for (const DraftSection& section : beam.sections) add_section(section);
  }

  void add_nacelle() {
    text_ += "\nnacelle:\n";
    add("nacelle", 2, "mass", exact(draft_.nacelle_mass), "kg");
    add("nacelle", 2, "center_of_mass", list(draft_.nacelle_center), "m");
    add("nacelle", 2, "inertia", list(draft_.nacelle_inertia), "kg m^2");
    add("nacelle", 2, "yaw",
        draft_.yaw_free ? "{joint: free, stiffness: " + exact(draft_.yaw_stiffness) +
                              ", damping: " + exact(draft_.yaw_damping) + "}"
                        : "{joint: locked}",
        "");
  }

  void add_shaft() {
    text_ += "\nshaft:\n";
    add("shaft", 2, "speed_rpm", exact(draft_.speed_rpm), "rev/min");
    add("shaft", 2, "overhang", exact(draft_.overhang), "m");
    add("shaft", 2, "tilt_deg", exact(draft_.tilt_deg), "");
    add("shaft", 2, "height", exact(draft_.height), "m");
    add("shaft", 2, "azimuth_deg", exact(draft_.azimuth_deg), "");
    add("shaft", 2, "torsion",
        draft_.has_torsion ? "{joint: free, stiffness: " + exact(draft_.torsion_stiffness) +
                                 ", damping: " + exact(draft_.torsion_damping) + "}"
                           : "{joint: locked}",
        "");
    add("shaft", 2, "gear_ratio", exact(draft_.gear_ratio), "");
    add("shaft", 2, "generator",
        "{joint: locked, own_inertia: " + exact(draft_.generator_inertia) + "}", "kg m^2");
  }

  void add_hub() {
    text_ += "\nhub:\n";
    add("hub", 2, "mass", exact(draft_.hub_mass), "kg");
    add("hub", 2, "center_of_mass", exact(draft_.hub_center), "m");
    add("hub", 2, "inertia", list(draft_.hub_inertia), "kg m^2");
    add("hub", 2, "radius", exact(draft_.hub_radius), "m");
    if (!draft_.has_teeter) return;
    text_ += "  teeter:\n";
    add("hub.teeter", 4, "joint", draft_.teeter_free ? "free" : "locked", "");
    add("hub.teeter", 4, "stiffness", exact(draft_.teeter_stiffness), "N m/rad");
    add("hub.teeter", 4, "damping", exact(draft_.teeter_damping), "N m s/rad");
    add("hub.teeter", 4, "undersling", exact(draft_.undersling), "m");
    add("hub.teeter", 4, "delta3_deg", exact(draft_.delta3_deg), "");
  }

  void add_blades() {
    text_ += "\nblades:\n";
    add("blades", 2, "count", std::to_string(draft_.blades), "");
    add("blades", 2, "precone_deg", exact(draft_.precone_deg), "");
    add("blades", 2, "pitch_deg", exact(draft_.pitch_deg), "");
    if (!draft_.each.empty()) text_ += "  each:\n";
    for (const auto& [number, difference] : draft_.each)
      text_ += "    " + std::to_string(number) + ": {pitch_deg: " + exact(difference.pitch_deg) +
               ", mass_factor: " + exact(difference.mass_factor) +
               ", stiffness_factor: " + exact(difference.stiffness_factor) + "}\n";
    add_beam("blades", draft_.blade);
  }

  const CaseDraft& draft_;
  std::string text_;
};

}  // namespace

std::string exact(double value) {
  if (value == 0.0) return "0";  // no -0
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end.ptr};
}

std::string rounded(double value, int digits) {
  std::array<char, 48> buffer{};
  const int size = std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  return {buffer.data(), static_cast<std::size_t>(size)};
}

std::string write_case_text(const CaseDraft& draft) { return Writer(draft).run(); }

}  // namespace samara::decks
