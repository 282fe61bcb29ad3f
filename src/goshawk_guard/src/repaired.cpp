#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/guard/guard.hpp"

namespace goshawk::guard {
namespace {

constexpr std::size_t kMostCorners = 64;
constexpr double kSamePoint_m = 1e-3;
constexpr double kBeforeObstacle_m = 0.1;
constexpr double kShortestPath_m = 0.05;
constexpr double kLeastWidth_m = 0.03;
constexpr double kLeastSpeed_m_s = 0.2;
constexpr double kSimplifyShare = 0.25;  // of how far the way may lead away
constexpr double kAhead_m = 0.2, kAhead_s = 0.3;

BezierPiece straight(const Vec3& a, const Vec3& b) {
  BezierPiece line;
  line.duration_s = 1.0;
  for (int i = 0; i < 6; ++i) line.control_points.col(i) = a + i / 5.0 * (b - a);
  return line;
}

// From where the vehicle is to the first place of the curve that is far enough ahead.
double meeting_s(const Trajectory& curve, double from_s, const FlatState& state) {
  const double duration_s = curve.duration_s();
  const double off_m = (curve.sample(from_s).position - state.position).norm();
  const double ahead_m = kAhead_m + off_m + kAhead_s * state.velocity.norm();
  constexpr int kSteps = 200;
  for (int i = 0; i < kSteps; ++i) {
    const double t_s = from_s + (duration_s - from_s) * i / kSteps;
    if ((curve.sample(t_s).position - state.position).norm() >= ahead_m) return t_s;
  }
  return duration_s;
}

double length_of(const std::vector<Vec3>& points) {
  double length_m = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    length_m += (points[i + 1] - points[i]).norm();
  }
  return length_m;
}

/// The polyline without its last part. @pre it is longer
void shorten(std::vector<Vec3>& points, double by_m) {
  while (points.size() > 2 && (points.back() - points[points.size() - 2]).norm() <= by_m) {
    by_m -= (points.back() - points[points.size() - 2]).norm();
    points.pop_back();
  }
  const Vec3& before = points[points.size() - 2];
  points.back() += by_m * (before - points.back()).normalized();
}

}  // namespace

// Where the polyline first enters an obstacle of the map it ends, a little before it.
std::optional<Guard::Refusal> Guard::cut_before_obstacle(std::vector<Vec3>& points) const {
  const VoxelGrid& map = *space_.grid();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto found = find_obstruction(map, straight(points[i], points[i + 1]));
    if (!found) continue;
    const Vec3 place = points[i] + found->time_s * (points[i + 1] - points[i]);
    points.resize(i + 2);
    points.back() = place;
    const double length_m = length_of(points);
    if (length_m > kBeforeObstacle_m + kShortestPath_m) {
      shorten(points, kBeforeObstacle_m);
    } else {
      points.clear();
    }
    return Refusal{fail(ErrorCode::trajectory_blocked, to_text(map, *found)), place};
  }
  return {};
}

// @param points where to fly @param planned what was planned, and how far that is from the plan
Guard::Or<Guard::Candidate> Guard::along(std::vector<Vec3> points, const Outline& planned,
                                         double v_most_m_s, const Join& join) const {
  const double within_m = kSimplifyShare * config_.follow_within_m;
  const Outline fewer = simplified(points, within_m);
  std::vector<Vec3> way = fewer.points_map;
  std::optional<Refusal> cut;
  if (way.size() > kMostCorners) {
    way.resize(kMostCorners);
    cut = Refusal{fail(ErrorCode::trajectory_infeasible,
                       fmt::format("it has {} corners, and only the way to the first {} is "
                                   "planned: send the rest in flight",
                                   fewer.points_map.size(), kMostCorners)),
                  way.back()};
  }
  if (auto obstacle = cut_before_obstacle(way)) cut = std::move(obstacle);
  if (cut && way.empty()) return *cut;
  if (length_of(way) < kShortestPath_m) {
    return Refusal{fail(ErrorCode::deadline_exceeded, "the vehicle is at its end already")};
  }
  auto nominal =
      repair_->along(task_of(way, fewer.deviation_m + planned.deviation_m, v_most_m_s, join));
  if (!nominal) return Refusal{nominal.error()};
  Outline reference = simplified(planned.points_map, within_m);
  if (reference.points_map.size() < 2) reference.points_map.push_back(planned.points_map.back());
  const double off_m = deviation_from(nominal->trajectory(), reference.points_map) +
                       reference.deviation_m + planned.deviation_m;
  return Candidate{*std::move(nominal), off_m, std::move(cut)};
}

RepairTask Guard::task_of(const std::vector<Vec3>& way, double error_m, double v_most_m_s,
                          const Join& join) const {
  RepairTask task{
      .start = join.state, .points_map = way, .limits = config_.limits(), .map = space_.grid()};
  task.limits.v_max_m_s = std::clamp(v_most_m_s, kLeastSpeed_m_s, config_.v_max_m_s);
  task.half_width_m =
      std::max(kLeastWidth_m, (config_.follow_within_m - error_m) / std::numbers::sqrt3);
  // Room to brake and turn from a motion that does not lead along the path.
  const double v_m_s = join.state.velocity.norm();
  task.start_half_width_m = task.half_width_m + v_m_s * v_m_s / config_.a_max_m_s2;
  return task;
}

Guard::Or<Guard::Candidate> Guard::repaired(const Curve& curve, const Join& join) const {
  const double from_s = meeting_s(curve.trajectory, join.plan_s, join.state);
  std::vector<Vec3> points{join.state.position};
  for (const Vec3& p : outline(curve.trajectory, from_s).points_map) {
    if ((p - points.back()).norm() > kSamePoint_m) points.push_back(p);
  }
  if (points.size() < 2) {
    return Refusal{fail(ErrorCode::deadline_exceeded, "the vehicle is at its end already")};
  }
  Outline planned = outline(curve.trajectory, join.plan_s);
  planned.deviation_m += curve.deviation_m;
  return along(std::move(points), planned, curve.trajectory.peaks(8).speed_m_s, join);
}

}  // namespace goshawk::guard
