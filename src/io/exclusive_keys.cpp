#include "exclusive_keys.hpp"

#include "samara/fields/description.hpp"
#include "samara/simulation/scenario_fields.hpp"

namespace samara::io {
namespace {

class ExclusiveKeyFinder : public fields::Description {
 public:
  ExclusiveKeys keys;

  void exclusive(std::initializer_list<Keys> groups) override {
    for (const Keys& group : groups)
      for (const Keys& other : groups)
        if (&group != &other)
          for (const char* key : group)
            for (const char* replaced : other) keys.emplace(key, replaced);
  }
};

}  // namespace

ExclusiveKeys find_exclusive_keys() {
  ExclusiveKeyFinder finder;
  simulation::Scenario scenario;
  simulation::declare(finder, scenario);
  return std::move(finder.keys);
}

}  // namespace samara::io
