#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace goshawk {

/// The finite number that a text is, from its first character to its last: "2.5", "-1e3", "+4".
/// @return nothing for any other text, such as "", "nan", "3 m" or "+-5"
inline std::optional<double> finite_number(std::string_view text) {
  // from_chars takes no plus sign.
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc{} && stop == text.data() + text.size();
  if (!whole || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace goshawk
