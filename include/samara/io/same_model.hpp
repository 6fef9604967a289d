// Whether two results are of one turbine.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace samara::io {

/// Values by key, as the lines `key: value` of Case::model_text state them.
using ModelKeys = std::map<std::string, std::string>;
ModelKeys model_keys(const std::string& text);

/// Refuses a result whose model, `there`, differs from the one `here` in another key than the
/// `free` ones and those below them; a `*` stands for any name in between.
/// @throws InputError
void require_same_model(const std::string& path, const std::string& there, const std::string& here,
                        std::span<const std::string_view> free = {});

/// Whether two models state the keys that begin with `start` alike.
bool states_alike(const std::string& there, const std::string& here, std::string_view start);

}  // namespace samara::io
