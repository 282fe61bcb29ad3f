#include "goshawk/core/stage_role.hpp"

#include <algorithm>
#include <array>

namespace goshawk {
namespace {

constexpr std::array<std::string_view, 13> kWords{
    "other",     "map_server", "path_search",     "corridor_builder", "trajectory_optimizer",
    "navigator", "tracker",    "vehicle",         "flight_check",     "viewer",
    "mission",   "guard",      "obstacle_tracker"};

}  // namespace

std::string_view to_string(StageRole role) {
  return kWords.at(std::size_t(role));
}

std::optional<StageRole> stage_role_of(std::string_view word) {
  const auto at = std::ranges::find(kWords, word);
  if (at == kWords.end()) return {};
  return StageRole(at - kWords.begin());
}

}  // namespace goshawk
