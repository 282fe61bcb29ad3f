#pragma once

#include <memory>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/words.hpp"

namespace goshawk {

/// May the vehicle go straight down from where it hovers, and stand on the ground there? Every
/// voxel of the vertical line must be free and known, whatever the policy for unknown space, down
/// to what the ground itself blocks. The ground is all that is occupied in the layer of voxels
/// that contains land_height_m, and below; grown, it blocks ceil(inflation / resolution) layers
/// more, and hides the sides of what is low: something that rises above that layer by h is seen
/// within sqrt(r^2 - (r - h)^2) of the line, r being the inflation, and within r where h >= r.
///
/// @param grid as the planning stages see it @pre grid.check() ok
/// @param from_map [m] where the vehicle's centre hovers
/// @param land_height_m [m] map height of the centre on the ground
/// @return goal_occupied or goal_unknown with the place that is in the way; goal_outside: the map
///         does not reach from there to the ground; invalid_input: not finite
Status check_way_down(const VoxelGrid& grid, const Vec3& from_map, double land_height_m);

/// When a vehicle that lost its pilot may land.
enum class LandingRule {
  map,       // if the newest map shows the way down free
  anywhere,  // everywhere: the ground is known to be free, no map is asked
  never,
};

constexpr auto words_of(LandingRule) {
  using enum LandingRule;
  return std::to_array<Named<LandingRule>>(
      {{map, "map"}, {anywhere, "anywhere"}, {never, "never"}});
}

/// Decides whether a vehicle that lost its pilot may land where it hovers.
///
///     LandingGuard guard(LandingRule::map, land_height_m);
///     guard.set_map(grid);                                  // whenever one comes
///     if (auto answer = guard.check(position)) land(); else hold(answer.error());
class LandingGuard {
 public:
  /// @param land_height_m [m] map height of the vehicle's centre on the ground
  LandingGuard(LandingRule rule, double land_height_m)
      : rule_(rule), land_height_m_(land_height_m) {}

  void set_map(std::shared_ptr<const VoxelGrid> grid) { grid_ = std::move(grid); }
  /// Without a map it cannot decide.
  bool needs_map() const { return rule_ == LandingRule::map && grid_ == nullptr; }

  /// @return all of check_way_down(); no_map if none has come; cancelled if it never lands
  Status check(const Vec3& from_map) const;

 private:
  LandingRule rule_;
  double land_height_m_;
  std::shared_ptr<const VoxelGrid> grid_;
};

}  // namespace goshawk
