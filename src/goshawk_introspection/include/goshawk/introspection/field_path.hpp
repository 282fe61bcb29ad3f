#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/introspection/schema.hpp"

namespace goshawk::introspection {

/// A part of a message, as users name it: "pose.position.x", "polytopes[2].b", "points[-1]" (the
/// last one).
class FieldPath {
 public:
  /// @param text empty: the whole message
  /// @return invalid_parameter that names the field: unknown (and the nearest known one), or
  /// indexed though it is not a list
  static Result<FieldPath> parse(const Type& type, std::string_view text);

  /// @param message of that type, as cdr_to_json() makes it
  /// @return nullptr if a list is too short
  const nlohmann::ordered_json* find(const nlohmann::ordered_json& message) const;

  /// The type of what it leads to; nullptr for values and lists.
  const Type* type() const { return type_; }

 private:
  std::vector<std::variant<std::string, int>> steps_;  // into fields and lists
  const Type* type_ = nullptr;
};

/// The values of a message or a part of it in the order of their fields, with commas between;
/// strings with a comma, a quote or a line's end in them in quotes (RFC 4180).
std::string to_csv(const nlohmann::ordered_json& json);

}  // namespace goshawk::introspection
