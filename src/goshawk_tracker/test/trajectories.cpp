#include "trajectories.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::tracker {
namespace {

template <typename Points>
double largest(const Points& points) {
  return points.colwise().norm().maxCoeff();
}

}  // namespace

Draft::operator CommittedTrajectory() const {
  auto certified = certify(trajectory, polytopes, limits, start, goal);
  return CommittedTrajectory::make({.id = id,
                                    .nominal = std::move(certified).value(),
                                    .start_time_ns = start_time_ns,
                                    .yaw_rad = yaw_rad,
                                    .yaw_curve = yaw_curve})
      .value();
}

std::shared_ptr<const CommittedTrajectory> Draft::shared() const {
  return std::make_shared<const CommittedTrajectory>(*this);
}

void certify_as_is(Draft& c) {
  c.polytopes = {Polytope::box(Vec3::Constant(-100.0), Vec3::Constant(100.0))};
  c.limits = {0.0, 0.0};
  for (const auto& piece : c.trajectory.pieces) {
    c.limits.v_max_m_s = std::max(c.limits.v_max_m_s, largest(piece.velocity_points()));
    c.limits.a_max_m_s2 = std::max(c.limits.a_max_m_s2, largest(piece.acceleration_points()));
  }
  c.start = c.trajectory.pieces.front().sample(0.0);
  c.goal = c.trajectory.pieces.back().sample(c.trajectory.pieces.back().duration_s);
}

Draft random_trajectory(Random& random, const Vec3& start, int pieces, double v_max_m_s,
                        double a_max_m_s2) {
  std::vector<FlatState> joints(std::size_t(pieces) + 1);
  std::vector<double> durations;
  joints[0].position = start;
  for (std::size_t k = 1; k < joints.size(); ++k) {
    joints[k].position =
        joints[k - 1].position +
        Vec3(random.uniform(-1.5, 1.5), random.uniform(0.5, 2.0), random.uniform(-0.5, 0.5));
    durations.push_back((joints[k].position - joints[k - 1].position).norm());
  }
  for (std::size_t k = 1; k + 1 < joints.size(); ++k) {
    joints[k].velocity =
        (joints[k + 1].position - joints[k - 1].position) / (durations[k - 1] + durations[k]);
    joints[k].acceleration = Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.0);
  }
  const auto build = [&](double scale) {  // time runs `scale` times slower
    Trajectory trajectory;
    for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
      FlatState a = joints[k], b = joints[k + 1];
      for (FlatState* s : {&a, &b}) {
        s->velocity /= scale;
        s->acceleration /= scale * scale;
      }
      trajectory.pieces.push_back(BezierPiece::between(a, b, scale * durations[k]));
    }
    return trajectory;
  };
  const auto peaks = build(1.0).peaks();
  Draft c;
  c.id = random.next();
  c.trajectory =
      build(std::max(peaks.speed_m_s / v_max_m_s, std::sqrt(peaks.acceleration_m_s2 / a_max_m_s2)));
  certify_as_is(c);
  return c;
}

Draft straight_line(const Vec3& start, const Vec3& end, double duration_s) {
  Draft c;
  c.id = 1;
  c.trajectory.pieces = {BezierPiece::between({.position = start}, {.position = end}, duration_s)};
  certify_as_is(c);
  return c;
}

}  // namespace goshawk::tracker
