// What the navigator does at rest so that it can plan: it leaves a place where no plan may begin,
// and looks where it is about to fly.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "goshawk/navigator/navigator.hpp"
#include "goshawk/navigator/way_out.hpp"
#include "times.hpp"

namespace goshawk::navigator {
namespace {

constexpr double kLookAhead_m = 1.0;  // along the plan
constexpr double kLooks_rad = 0.1;    // it looks there already
constexpr double kTurn_rad_s = 1.0;   // slower than the tracker turns
constexpr double kSettle_s = 0.5;     // and a scan comes
constexpr double kStill_m = 1e-3;     // half the edge of the box that it stays in

// [rad] the heading of the way, or nothing if it does not lead aside
std::optional<double> heading_of(const Trajectory& way) {
  const Vec3 from = way.sample(0.0).position;
  Vec3 aside = Vec3::Zero();
  constexpr double kStep_s = 0.05;
  for (double t_s = 0.0; t_s < way.duration_s() && aside.norm() < kLookAhead_m; t_s += kStep_s) {
    aside = way.sample(t_s).position - from;
    aside.z() = 0.0;
  }
  if (aside.norm() < 0.1 * kLookAhead_m) return {};
  return std::atan2(aside.y(), aside.x());
}

}  // namespace

// To be flown from now on, from rest to rest.
Commitment Navigator::from_rest(CertifiedTrajectory way, std::int64_t now_ns) {
  return {.id = next_id_++,
          .nominal = std::move(way),
          .start_time_ns = now_ns + to_ns(config_.commit_lead_s + longer_lead_s(pursuit_.failures)),
          .map_version = map()->version,
          .yaw_rad = yaw_of(vehicle_.q_map_base)};
}

// It leads to no goal: plans begin at its end.
void Navigator::commit_own(CommittedTrajectory committed) {
  brake_by(std::move(committed));
  pursuit_.not_before_ns = schedule_.end_ns();
}

// The vehicle rests where no plan may begin. @return whether it leaves by a way of its own: then
// plans begin at the end of that
bool Navigator::leave_blocked_place(std::int64_t now_ns) {
  if (!space_.asks_for_known() || map()->raw.empty()) return false;
  const Vec3 place_map = start_at_rest(now_ns).state.position;
  const auto voxel = map()->geometry.index_of(place_map);
  if (!voxel || !map()->grown.get(*voxel)) return false;
  auto way = way_out(place_map, space_, limits_from({}));
  if (!way) return false;
  auto committed = CommittedTrajectory::make(from_rest(*std::move(way), now_ns));
  if (!committed) return false;
  commit_own(*std::move(committed));
  return true;
}

// A plan from rest leads at once into space that was never seen, but the vehicle does not look
// there: it turns, and the goal is planned for again. @return whether it turns
bool Navigator::look_along(const Trajectory& way, std::int64_t now_ns) {
  const auto heading_rad = heading_of(way);
  if (!heading_rad) return false;
  const double turn_rad =
      std::abs(std::remainder(*heading_rad - yaw_of(vehicle_.q_map_base), 2.0 * std::numbers::pi));
  if (turn_rad < kLooks_rad) return false;
  const FlatState rest{.position = way.sample(0.0).position};
  Trajectory still{{BezierPiece::between(rest, rest, turn_rad / kTurn_rad_s + kSettle_s)}};
  const Vec3 half = Vec3::Constant(kStill_m);
  auto certified =
      certify(std::move(still), {Polytope::box(rest.position - half, rest.position + half)},
              limits_from({}), rest, rest);
  if (!certified) return false;
  Commitment content = from_rest(*std::move(certified), now_ns);
  content.yaw_rad = *heading_rad;
  auto committed = CommittedTrajectory::make(std::move(content));
  if (!committed) return false;
  drop_open();
  commit_own(*std::move(committed));
  pursuit_.retry_ns = schedule_.end_ns();
  enter(State::flying, now_ns,
        {ErrorCode::trajectory_blocked,
         "the way leads into space that was never seen: looking there"});
  return true;
}

}  // namespace goshawk::navigator
