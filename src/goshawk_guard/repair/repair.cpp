#include "goshawk/guard/repair.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::guard {
namespace {

constexpr double kLeastOverlap_m = 1e-3;

corridor_builder::Config along_the_path() {
  corridor_builder::Config config;
  config.bend_path = false;
  config.drop_covered = false;
  return config;
}

/// A box around a segment, along it: what is in it is near the segment.
void cut_to_tube(Polytope& polytope, const Vec3& a, const Vec3& b, double half_width_m) {
  const Vec3 along = (b - a).normalized();
  int least = 0;
  along.cwiseAbs().minCoeff(&least);
  const Vec3 side = along.cross(Vec3::Unit(least)).normalized();
  const Vec3 other = along.cross(side);
  for (const Vec3& n : {side, other, Vec3(-side), Vec3(-other)}) {
    polytope.add(n, n.dot(a) + half_width_m);
  }
  polytope.add(along, along.dot(b) + half_width_m);
  polytope.add(-along, -along.dot(a) + half_width_m);
}

class TubeRepair : public Repair {
 public:
  Result<CertifiedTrajectory> along(const RepairTask& task) override {
    auto corridor = builder_.build(*task.map, task.points_map);
    if (!corridor) return corridor.error();
    for (std::size_t k = 0; k < corridor->polytopes.size(); ++k) {
      const auto& points = corridor->waypoints_map;
      cut_to_tube(corridor->polytopes[k], points[k], points[k + 1],
                  k == 0 ? task.start_half_width_m : task.half_width_m);
    }
    for (std::size_t k = 0; k < corridor->overlaps.size(); ++k) {
      corridor->overlaps[k] = chebyshev_ball(corridor->polytopes[k], corridor->polytopes[k + 1]);
      if (corridor->overlaps[k].radius_m >= kLeastOverlap_m) continue;
      return fail(ErrorCode::corridor_disjoint,
                  fmt::format("there is no room to turn at {} m within {:.2g} m of the path",
                              to_text(corridor->waypoints_map[k + 1]), task.half_width_m));
    }
    PlanRequest request;
    request.id = 1;
    request.start = task.start;
    if (task.start.velocity.norm() > 1e-3) request.start_time_ns = 1;
    request.goal.position = task.points_map.back();
    request.limits = task.limits;
    auto solution = optimizer_.optimise(request, *corridor);
    if (!solution) return solution.error();
    return std::move(solution->certified);
  }

 private:
  corridor_builder::CorridorBuilder builder_ =
      corridor_builder::CorridorBuilder::create(along_the_path()).value();
  trajectory_optimizer::TrajectoryOptimizer optimizer_ =
      trajectory_optimizer::TrajectoryOptimizer::create({}).value();
};

}  // namespace

std::unique_ptr<Repair> make_repair() {
  return std::make_unique<TubeRepair>();
}

}  // namespace goshawk::guard
