#pragma once

#include <string_view>

#include "goshawk/core/random.hpp"
#include "guard_lab.hpp"

namespace goshawk::guarded {

/// Planners that nobody should let fly.
enum class Fault {
  blind,      // straight to the goal, through whatever is there
  jerky,      // curves at random
  overspeed,  // three times as fast as is allowed
  late,       // plans that come up to a second after their start
  forgetful,  // each begins where the vehicle was, at rest, though it flies
  path        // blind, and without times
};
inline constexpr int kFaults = 6;
std::string_view to_string(Fault fault);

/// Sends the plans of such a planner whenever it has one.
class BadPlanner {
 public:
  BadPlanner(Fault fault, const Vec3& goal_map, std::uint64_t seed)
      : fault_(fault), goal_map_(goal_map), random_(seed) {}

  /// Call it every 20 ms.
  void tick(GuardLab& lab);

 private:
  guard::Plan plan(const GuardLab& lab);
  guard::Plan spline(const std::vector<Vec3>& points, double knot_s, std::int64_t start_ns) const;

  Fault fault_;
  Vec3 goal_map_;
  Random random_;
  std::int64_t next_ns_ = 0;
};

}  // namespace goshawk::guarded
