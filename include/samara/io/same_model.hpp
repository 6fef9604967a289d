// Compares the models of two results.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace samara::io {

/// Values by key, as the lines `key: value` of Case::model_text state them.
using ModelKeys = std::map<std::string, std::string>;
ModelKeys model_keys(const std::string& text);

/// Refuses a result if its model `there` differs from the model `here` in any key except the `free`
/// keys and the keys below them. A `*` in a `free` key stands for any name.
/// @throws InputError
void require_same_model(const std::string& path, const std::string& there, const std::string& here,
                        std::span<const std::string_view> free = {});

/// True if the keys that begin with `start` have the same values in both models.
bool states_alike(const std::string& there, const std::string& here, std::string_view start);

}  // namespace samara::io
