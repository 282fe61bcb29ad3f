#include "waypoints.hpp"

#include <algorithm>

namespace goshawk::corridor_builder {
namespace {

constexpr double kNearlyAsGood = 0.7;
constexpr double kSolverRounding = 1e-6;  // [voxel edges] balls are found by a linear programme

// How far from `from` (0) to `center` (1) a point has at least `clearance` to every face: slacks
// are linear along the way.
double needed_step(const Polytope& polytope, const Vec3& from, const Vec3& center,
                   double clearance) {
  double step = 0.0;
  for (const HalfSpace& face : polytope.half_spaces) {
    const double here = -face.distance_m(from);
    if (here >= clearance) continue;
    const double there = -face.distance_m(center);
    step = std::max(step, there > clearance ? (clearance - here) / (there - here) : 1.0);
  }
  return std::min(step, 1.0);
}

void drop_first(Chain& chain) {
  chain.erase(0);
  chain.waypoints_map.erase(chain.waypoints_map.begin() + 1);
  chain.overlaps.erase(chain.overlaps.begin());
}

void drop_last(Chain& chain) {
  chain.erase(chain.size() - 1);
  chain.waypoints_map.erase(chain.waypoints_map.end() - 2);
  chain.overlaps.pop_back();
}

void drop_inner(std::size_t k, const Ball& shortcut, Chain& chain) {
  chain.waypoints_map[k] = 0.5 * (chain.waypoints_map[k] + chain.waypoints_map[k + 1]);
  chain.waypoints_map.erase(chain.waypoints_map.begin() + std::ptrdiff_t(k) + 1);
  chain.erase(k);
  chain.overlaps[k - 1] = shortcut;
  chain.overlaps.erase(chain.overlaps.begin() + std::ptrdiff_t(k));
}

}  // namespace

void measure_overlaps(Chain& chain) {
  chain.overlaps.clear();
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    chain.overlaps.push_back(chebyshev_ball(chain[k], chain[k + 1]));
  }
}

void drop_covered(double resolution_m, double start_room_m, double goal_room_m, Chain& chain) {
  while (chain.size() > 1 && -chain[1].violation(chain.waypoints_map.front()) >= start_room_m) {
    drop_first(chain);
  }
  while (chain.size() > 1 &&
         -chain[chain.size() - 2].violation(chain.waypoints_map.back()) >= goal_room_m) {
    drop_last(chain);
  }
  const double half_voxel_m = (kHalfVoxel - kSolverRounding) * resolution_m;
  for (std::size_t k = 1; k + 1 < chain.size();) {
    const Ball shortcut = chebyshev_ball(chain[k - 1], chain[k + 1]);
    const double before = std::min(chain.overlaps[k - 1].radius_m, chain.overlaps[k].radius_m);
    if (shortcut.radius_m >= std::max(half_voxel_m, kNearlyAsGood * before)) {
      drop_inner(k, shortcut, chain);
    } else {
      ++k;
    }
  }
}

void settle_waypoints(double clearance_m, Chain& chain) {
  for (std::size_t k = 0; k < chain.overlaps.size(); ++k) {
    const Ball& ball = chain.overlaps[k];
    const double clearance = std::min(clearance_m, ball.radius_m);
    Vec3& waypoint = chain.waypoints_map[k + 1];
    const double step = std::max(needed_step(chain[k], waypoint, ball.center_map, clearance),
                                 needed_step(chain[k + 1], waypoint, ball.center_map, clearance));
    waypoint += step * (ball.center_map - waypoint);
  }
}

}  // namespace goshawk::corridor_builder
