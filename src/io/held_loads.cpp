#include "held_loads.hpp"

#include "samara/base/error.hpp"

namespace samara::io {
namespace {

constexpr char names[] = "/held_name";
constexpr char loads[] = "/held_load";
constexpr char unit[] = "N m";

}  // namespace

void write_held_loads(Hdf5File& file, const std::string& group,
                      const std::vector<analysis::HeldCoordinate>& held,
                      const std::string& description) {
  std::vector<std::string> words;
  std::vector<double> values;
  for (const analysis::HeldCoordinate& coordinate : held) {
    words.push_back(coordinate.name);
    values.push_back(coordinate.load);
  }
  file.write(group + names, words, {"", "none", description, {"held_name"}});
  file.write(group + loads, values, {values.size()},
             {unit,
              "about the joint",
              "constant load on each of held_name; for a generator, at the shaft's end of its gear",
              {"held_name"}});
}

std::vector<analysis::HeldCoordinate> read_held_loads(const Hdf5Reader& file,
                                                      const std::string& group) {
  std::vector<analysis::HeldCoordinate> held;
  const std::vector<double> values = file.numbers(group + loads);
  const std::vector<std::string> words = file.texts(group + names);
  if (values.size() != words.size())
    throw InputError(group + names + " and " + group + loads + " differ in length");
  for (std::size_t i = 0; i < words.size(); ++i) held.push_back({words[i], unit, values[i]});
  return held;
}

}  // namespace samara::io
