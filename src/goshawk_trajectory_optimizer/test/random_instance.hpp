#pragma once

// Random problems for the solvers, as the optimiser makes them from a corridor.
#include <cmath>
#include <vector>

#include "corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/plan_problem.hpp"

namespace goshawk::trajectory_optimizer::test {

/// A request, its plan and the problem made of them.
struct Instance {
  Corridor corridor;
  FlatState start, goal;
  Limits limits;
  Plan plan;
  SplineProblem problem;
  Units units;
  bool inside = true;  // of what the ends alone decide

  PlanRequest request() const { return ask(start, goal, limits); }
  std::vector<Polytope> polytopes_in_units() const {
    std::vector<Polytope> all;
    for (const int k : plan.polytopes) {
      Polytope p = corridor.polytopes[std::size_t(k)];
      for (HalfSpace& face : p.half_spaces) {
        face.offset_m = (face.offset_m - face.normal.dot(units.origin_map)) / units.length_m;
      }
      all.push_back(p);
    }
    return all;
  }
};

/// Of a random kind.
inline Limits random_limits(Random& random) {
  Limits limits{.v_max_m_s = random.uniform(0.5, 4.0), .a_max_m_s2 = random.uniform(0.5, 4.0)};
  constexpr LimitNorm kNorms[] = {LimitNorm::euclidean, LimitNorm::per_axis,
                                  LimitNorm::horizontal_vertical};
  limits.norm = kNorms[random.below(3)];
  if (limits.norm == LimitNorm::horizontal_vertical) {
    limits.v_max_vertical_m_s = random.uniform(0.3, 2.0);
    limits.a_max_vertical_m_s2 = random.uniform(0.3, 2.0);
  }
  return limits;
}

/// A small problem from a random corridor; with fixed durations some fly already.
inline Instance random_instance(Random& random, bool scale, double stretch) {
  Instance i;
  CorridorKind kind;
  kind.segments = 1 + random.below(2);
  kind.planes = 6 + random.below(5);
  kind.least_length_m = 0.3;
  kind.most_length_m = 1.5;
  i.corridor = random_corridor(random, kind);
  i.start = at_rest(i.corridor.waypoints_map.front());
  i.goal = at_rest(i.corridor.waypoints_map.back());
  i.limits = random_limits(random);
  if (!scale && random.chance(0.3)) {
    i.start.velocity = random.uniform(0.0, 0.3) * random_direction(random);
    i.start.acceleration = random.uniform(0.0, 0.3) * random_direction(random);
  }
  Config config;
  config.min_pieces = 2;
  config.piece_duration_s = random.uniform(2.0, 10.0);
  i.plan = cut_trapezoid(i.request(), i.corridor, config);
  for (double& duration : i.plan.durations_s) duration *= stretch * random.uniform(0.8, 1.25);
  const ProblemSettings settings{.scale = scale,
                                 .time_weight = std::pow(10.0, random.uniform(-2.0, 2.0))};
  i.inside = make_problem(i.request(), i.corridor, i.plan, settings, i.problem, i.units);
  return i;
}

inline double difference(const std::vector<Knot>& a, const std::vector<Knot>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, (a[k].col(0) - b[k].col(0)).cwiseAbs().maxCoeff());
  }
  return largest;
}

}  // namespace goshawk::trajectory_optimizer::test
