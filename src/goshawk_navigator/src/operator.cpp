// What an operator commands: hold, resume, land and take off.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/navigator/navigator.hpp"
#include "times.hpp"

namespace goshawk::navigator {
namespace {

Error no_odometry() {
  return fail(ErrorCode::tracking_lost,
              "no odometry comes, so it is not known where the vehicle is");
}

Vec3 end_of(const CommittedTrajectory& committed) {
  return committed.flown().sample(committed.flown().duration_s()).position;
}

}  // namespace

void Navigator::hold(std::int64_t now_ns) {
  if (state_ == State::idle) return;
  drop_open();
  pursuit_.open = false;
  pursuit_.revoked_ns.reset();
  pursuit_.map_retry.reset();
  if (left_) left_->answers = false;
  brake_again_ns_ = now_ns;
  enter(State::held, now_ns, {ErrorCode::ok, "an operator holds the vehicle"});
  hold_on(now_ns);
}

// A curve may be at its limits where it is tried first.
void Navigator::hold_on(std::int64_t now_ns) {
  if (state_ != State::held || now_ns < brake_again_ns_) return;
  brake_again_ns_ = now_ns + to_ns(kBrakeAgain_s);
  if (schedule_.moves(now_ns) && !brakes()) brake(now_ns);
}

Status Navigator::resume_held(std::int64_t now_ns) {
  if (state_ != State::held) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the vehicle is not held: the navigator is {}", to_string(state_)));
  }
  const Goal goal = pursuit_.goal;
  return on_goal(goal, now_ns);
}

// Where a vehicle that brakes will rest; else where it is.
Vec3 Navigator::rest_place(std::int64_t now_ns) const {
  if (!schedule_.moves(now_ns) || !brakes()) return vehicle_.position_map;
  return schedule_.last()->at(schedule_.end_ns()).position;
}

// Straight down, from voxel to voxel. Below the map nothing is known: the body stays inside.
Descent Navigator::lowest_below(const Vec3& from_map, Index3 lowest) const {
  const GridGeometry& geometry = map()->geometry;
  const double floor_m = geometry.origin_map.z() + map()->inflation_m;
  const auto next = [&lowest] { return Index3{lowest.x, lowest.y, lowest.z - 1}; };
  const auto is_inside = [&] { return geometry.center(next()).z() >= floor_m; };
  while (is_inside() && space_.is_free(next())) --lowest.z;
  Descent descent{.end_map = from_map, .below = Descent::Below::map_floor};
  descent.end_map.z() = std::min(from_map.z(), geometry.center(lowest).z());
  if (!is_inside()) return descent;
  const bool seen = map()->grown.test(next()) && map()->is_known(next());
  descent.below = seen ? Descent::Below::obstacle : Descent::Below::unknown;
  return descent;
}

Result<Descent> Navigator::land(std::int64_t now_ns) {
  if (!odometry_is_fresh(now_ns)) return no_odometry();
  if (map() == nullptr) {
    return fail(ErrorCode::no_map, "no map has come, so the way down cannot be checked");
  }
  auto braked = brakes() ? std::nullopt : way_to_rest(now_ns);
  const Vec3 from_map = braked ? end_of(*braked) : rest_place(now_ns);
  const auto above = locate(*map(), from_map, Endpoint::start);
  if (!above) return above.error();
  if (!space_.is_free(*above)) {
    return fail(ErrorCode::start_unknown,
                fmt::format("the vehicle's own place {} was not seen free: climb first",
                            to_text(from_map)));
  }
  if (braked) brake_by(*std::move(braked));
  const Descent descent = lowest_below(from_map, *above);
  const Goal goal{descent.end_map, yaw_of(vehicle_.q_map_base), config_.operator_speed_m_s};
  if (auto status = on_goal(goal, now_ns); !status) return status.error();
  return descent;
}

Result<Vec3> Navigator::take_off(double height_m, std::int64_t now_ns) {
  if (!(std::isfinite(height_m) && height_m > 0.0)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("a takeoff climbs by a height above 0, not by {:g} m", height_m));
  }
  if (!odometry_is_fresh(now_ns)) return no_odometry();
  const Vec3 end_map = rest_place(now_ns) + Vec3(0.0, 0.0, height_m);
  const Goal goal{end_map, yaw_of(vehicle_.q_map_base), config_.operator_speed_m_s};
  if (auto status = on_goal(goal, now_ns); !status) return status.error();
  return end_map;
}

}  // namespace goshawk::navigator
