#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

#include "goshawk/navigator/navigator.hpp"

namespace goshawk::navigator {

// What an operator is told of a command.

inline Result<std::string> sentence(const Status& status, const char* done) {
  if (!status) return status.error();
  return std::string(done);
}

inline Result<std::string> sentence(const Result<Descent>& descent) {
  if (!descent) return descent.error();
  constexpr std::array below{"an obstacle or the ground is below", "below, nothing was ever seen",
                             "the map ends below"};
  return fmt::format("descends to {} and rests there with its motors on: {}",
                     to_text(descent->end_map), below.at(std::size_t(descent->below)));
}

inline Result<std::string> sentence(const Result<Vec3>& place_map) {
  if (!place_map) return place_map.error();
  return "climbs to " + to_text(*place_map);
}

}  // namespace goshawk::navigator
