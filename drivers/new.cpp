// samara new: a commented case to start from.
#include <algorithm>
#include <iostream>
#include <vector>

#include "samara/base/error.hpp"
#include "samara/base/words.hpp"
#include "samara/io/whole_file.hpp"

#include "commands.hpp"
#include "installation.hpp"

namespace samara::drivers {
namespace {

namespace fs = std::filesystem;

constexpr char usage[] = "samara new KIND NAME";
/// Stands for the name in the templates.
constexpr char name_of_template[] = "NAME";

std::vector<std::string> find_kinds(const fs::path& folder) {
  std::vector<std::string> kinds;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") kinds.push_back(entry.path().stem().string());
  std::ranges::sort(kinds);
  return kinds;
}

}  // namespace

void run_new(const std::vector<std::string>& arguments) {
  const fs::path folder = find_installed("templates");
  if (folder.empty())
    throw InputError(
        "the folder of the templates is missing beside the program and in "
        "share/samara; hint: install samara as a whole");
  const std::vector<std::string> kinds = find_kinds(folder);
  if (arguments.size() == 1 && (arguments[0] == "--help" || arguments[0] == "-h")) {
    std::cout << usage << "\n\nWrites a commented case NAME.yaml to start from.\n\nkinds\n  "
              << join(kinds, ", ") << "\n\nexample\n  samara new three-bladed mine\n";
    return;
  }
  for (const std::string& word : arguments)
    if (word.starts_with("-")) throw InputError("unknown option " + word + "; hint: " + usage);
  if (arguments.size() != 2)
    throw InputError(std::string("expected a kind and a name: ") + usage +
                     "; hint: the kinds are " + join(kinds, ", "));
  if (std::ranges::find(kinds, arguments[0]) == kinds.end())
    throw InputError("unknown kind \"" + arguments[0] + "\"" +
                     suggest(arguments[0], kinds, "; hint: the kinds are " + join(kinds, ", ")));
  fs::path path = arguments[1];
  if (path.extension() != ".yaml" && path.extension() != ".yml") path += ".yaml";
  if (io::require_writable(path.string()))
    throw InputError(path.string() + ": exists; hint: another name");
  std::string text =
      io::read_whole_file((folder / (arguments[0] + ".yaml")).string(), 1, "template");
  const std::string name = path.stem().string();
  if (name.find_first_of("\"\\\n") != std::string::npos)
    throw InputError("the name has a quote or a backslash; hint: another name");
  for (std::size_t i = text.find(name_of_template); i != std::string::npos;
       i = text.find(name_of_template, i + name.size()))
    text.replace(i, std::size(name_of_template) - 1, name);
  io::write_whole_file(path.string(), text);
  std::cout << "case: " << path.string() << "\nnext: samara check " << path.string() << "\n";
}

}  // namespace samara::drivers
