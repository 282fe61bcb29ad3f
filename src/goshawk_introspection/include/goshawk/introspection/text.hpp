#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "goshawk/core/result.hpp"
#include "goshawk/introspection/schema.hpp"

namespace goshawk::introspection {

/// A message that a user typed for `topic pub`: JSON, or YAML, of which JSON is a part.
/// @return invalid_input if it is neither
Result<nlohmann::ordered_json> parse_json_or_yaml(const std::string& text);

/// A message as `ros2 topic echo` shows it: block style, lists of numbers in one line. The name of
/// a constant follows its value as a comment: `state: 3  # STATE_ARRIVED`.
/// @param json of that type, as cdr_to_json() makes it
std::string to_yaml(const Type& type, const nlohmann::ordered_json& json);

/// One line; bytes that are not UTF-8 are replaced.
std::string to_line(const nlohmann::ordered_json& json);

/// Lists of more than a few elements become "<N elements>".
void shorten_arrays(nlohmann::ordered_json& json);

}  // namespace goshawk::introspection
