#pragma once

// Random corridors with the structure that a corridor builder promises: a chain of polytopes,
// each around its segment, consecutive ones sharing a ball.
#include <algorithm>
#include <cmath>

#include "goshawk/core/plan_request.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::trajectory_optimizer::test {

inline Vec3 random_direction(Random& random) {
  for (;;) {
    const Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
  }
}

inline void fill_overlaps(Corridor& corridor) {
  corridor.overlaps.clear();
  for (std::size_t k = 0; k + 1 < corridor.polytopes.size(); ++k) {
    corridor.overlaps.push_back(chebyshev_ball(corridor.polytopes[k], corridor.polytopes[k + 1]));
  }
}

struct CorridorKind {
  int segments = 4;
  double least_length_m = 0.5, most_length_m = 3.5;
  double least_clearance_m = 0.08, most_clearance_m = 1.0;
  int planes = 16;  // of each polytope, the six of its box included
  double most_turn_rad = 2.0;
};

/// A box around the segment and random planes that all keep the segment inside.
inline Polytope around_segment(Random& random, const Vec3& a, const Vec3& b,
                               const CorridorKind& kind) {
  const auto clearance = [&] {
    return random.uniform(kind.least_clearance_m, kind.most_clearance_m);
  };
  const Vec3 lower = a.cwiseMin(b) - Vec3(clearance(), clearance(), clearance());
  const Vec3 upper = a.cwiseMax(b) + Vec3(clearance(), clearance(), clearance());
  Polytope polytope = Polytope::box(lower, upper);
  while (polytope.faces() < kind.planes) {
    const Vec3 n = random_direction(random);
    polytope.add(n, std::max(n.dot(a), n.dot(b)) + clearance());
  }
  return polytope;
}

inline Corridor random_corridor(Random& random, const CorridorKind& kind) {
  Corridor corridor;
  Vec3 at(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(0, 4));
  Vec3 heading = random_direction(random);
  corridor.waypoints_map.push_back(at);
  for (int k = 0; k < kind.segments; ++k) {
    Vec3 next = random_direction(random);
    while (std::acos(std::clamp(next.dot(heading), -1.0, 1.0)) > kind.most_turn_rad) {
      next = random_direction(random);
    }
    heading = next;
    const Vec3 to = at + random.uniform(kind.least_length_m, kind.most_length_m) * heading;
    corridor.polytopes.push_back(around_segment(random, at, to, kind));
    corridor.waypoints_map.push_back(to);
    at = to;
  }
  fill_overlaps(corridor);
  return corridor;
}

/// One long box along x.
inline Corridor straight_corridor(double length_m, double half_width_m = 1.0) {
  Corridor corridor;
  corridor.waypoints_map = {Vec3::Zero(), Vec3(length_m, 0, 0)};
  const Vec3 margin = Vec3::Constant(half_width_m);
  corridor.polytopes = {Polytope::box(-margin, Vec3(length_m, 0, 0) + margin)};
  return corridor;
}

inline FlatState at_rest(const Vec3& position) {
  FlatState state;
  state.position = position;
  return state;
}

inline PlanRequest ask(const FlatState& start, const FlatState& goal, const Limits& limits = {}) {
  return {.start = start, .goal = goal, .limits = limits};
}

/// From the corridor's first waypoint to its last, both at rest.
inline PlanRequest ask(const Corridor& corridor, const Limits& limits = {}) {
  return ask(at_rest(corridor.waypoints_map.front()), at_rest(corridor.waypoints_map.back()),
             limits);
}

inline double path_length(const Corridor& corridor) {
  double length = 0.0;
  for (std::size_t k = 0; k + 1 < corridor.waypoints_map.size(); ++k) {
    length += (corridor.waypoints_map[k + 1] - corridor.waypoints_map[k]).norm();
  }
  return length;
}

}  // namespace goshawk::trajectory_optimizer::test
