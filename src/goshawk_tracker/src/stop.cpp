#include "goshawk/tracker/stop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace goshawk::tracker {
namespace {

constexpr double kShortest_s = 0.5;
// A stop is a smooth step of the speed: it peaks at 3/2 of the mean deceleration.
constexpr double kPeak = 1.5;
constexpr int kSamples = 16;
// Back to the path over this distance at the most: nothing of a voxel's size, grown, fits between.
constexpr double kNear_m = 0.3;
constexpr double kReturnSpeed_m_s = 0.3;
constexpr double kSearchStep_s = 0.02;
constexpr double kWalkStep_s = 0.005;
constexpr double kLongestWalk_s = 5.0;
constexpr double kEqual_s = 1e-3;  // contacts that come within this time come together

struct PathPoint {
  double time_s;
  double distance_m;  // of the vehicle
};

PathPoint nearest(const LeftPath& path, const Vec3& position) {
  PathPoint best{path.from_s, HUGE_VAL};
  const int steps = std::max(1, int(std::ceil((path.to_s - path.from_s) / kSearchStep_s)));
  for (int i = 0; i <= steps; ++i) {
    const double t = path.from_s + (path.to_s - path.from_s) * i / steps;
    const double distance = (path.trajectory->sample(t).position - position).norm();
    if (distance < best.distance_m) best = {t, distance};
  }
  return best;
}

/// The point that lies `distance_m` farther along the path, or its end, or where a path that hardly
/// moves has got to by then.
Vec3 farther(const Trajectory& path, double time_s, double distance_m) {
  const double end_s = std::min(path.duration_s(), time_s + kLongestWalk_s);
  Vec3 position = path.sample(time_s).position;
  for (double left = distance_m; left > 0.0 && time_s < end_s;) {
    time_s = std::min(end_s, time_s + kWalkStep_s);
    const Vec3 next = path.sample(time_s).position;
    left -= (next - position).norm();
    position = next;
  }
  return position;
}

class StopPlanner {
 public:
  StopPlanner(const FlatState& vehicle, const std::optional<LeftPath>& path,
              const StopLimits& limits, const FirstContact& first_contact)
      : vehicle_(vehicle), limits_(limits), first_contact_(first_contact) {
    // Speeding up ends at once: a stop is never faster than the vehicle was.
    const Vec3 ahead = vehicle.velocity.stableNormalized();
    vehicle_.acceleration -= std::max(0.0, ahead.dot(vehicle.acceleration)) * ahead;
    if (!path) return;
    const PathPoint point = nearest(*path, vehicle.position);
    if (point.distance_m > kNear_m) return;
    path_ = path->trajectory;
    point_ = point;
    tangent_ = path_->sample(point.time_s).velocity.stableNormalized();
  }

  Stop plan() const {
    std::optional<Stop> best;
    const double ratio = limits_.hardest_m_s2 / limits_.gentle_m_s2;
    for (const double power : {0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0}) {
      const double deceleration = limits_.gentle_m_s2 * std::pow(ratio, power);
      // Of equal ones: a harder stop rather than a gentler one, back to the path rather than ahead.
      double later_by_s = -kEqual_s;
      for (const bool back : {true, false}) {
        if (back && path_ == nullptr) continue;
        const BezierPiece curve = back ? back_to_path(deceleration) : straight(deceleration);
        if (!is_within_limits(curve)) continue;
        const Stop stop{curve, first_contact_(curve)};
        if (!stop.enters_s) return stop;
        if (!best || *stop.enters_s > *best->enters_s + later_by_s) best = stop;
        later_by_s = kEqual_s;
      }
    }
    if (best) return *best;
    const BezierPiece hardest =
        path_ != nullptr ? back_to_path(limits_.hardest_m_s2) : straight(limits_.hardest_m_s2);
    return {hardest, first_contact_(hardest)};
  }

 private:
  bool is_within_limits(const BezierPiece& piece) const {
    const double hardest = std::max(limits_.hardest_m_s2, vehicle_.acceleration.norm());
    const double fastest = std::max(vehicle_.velocity.norm(), 2.0 * kReturnSpeed_m_s);
    for (int i = 0; i <= kSamples; ++i) {
      const FlatState state = piece.sample(piece.duration_s * i / kSamples);
      const bool within =
          state.velocity.norm() <= 1.05 * fastest && state.acceleration.norm() <= 1.05 * hardest;
      if (!within) return false;
    }
    return true;
  }

  BezierPiece straight(double deceleration) const {
    const double duration = std::max(kShortest_s, kPeak * vehicle_.velocity.norm() / deceleration);
    const Vec3 end = vehicle_.position + duration / 2.0 * vehicle_.velocity;
    return BezierPiece::between(vehicle_, {.position = end}, duration);
  }

  BezierPiece back_to_path(double deceleration) const {
    const double along = std::max(0.0, tangent_.dot(vehicle_.velocity));
    const double aside = (vehicle_.velocity - along * tangent_).norm();
    const double return_speed = kReturnSpeed_m_s * deceleration / limits_.gentle_m_s2;
    const double duration = std::max({kShortest_s, kPeak * (along + aside) / deceleration,
                                      2.0 * point_.distance_m / return_speed});
    const Vec3 end = farther(*path_, point_.time_s, along * duration / 2.0);
    return BezierPiece::between(vehicle_, {.position = end}, duration);
  }

  FlatState vehicle_;
  StopLimits limits_;
  const FirstContact& first_contact_;
  const Trajectory* path_ = nullptr;
  PathPoint point_{0.0, 0.0};
  Vec3 tangent_ = Vec3::Zero();
};

}  // namespace

Stop plan_stop(const FlatState& vehicle, const std::optional<LeftPath>& path,
               const StopLimits& limits, const FirstContact& first_contact) {
  return StopPlanner(vehicle, path, limits, first_contact).plan();
}

}  // namespace goshawk::tracker
