#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/movers/motion.hpp"
#include "yaw.hpp"

namespace goshawk::movers {
namespace {

constexpr double kJump_m_s = 100.0;
constexpr double kJump_rad_s = 30.0;
constexpr double kSamePlace_m = 1e-3, kSameHeading_rad = 1e-3;

bool is_usable(const Place& p) {
  return std::isfinite(p.t_s) && is_finite(p.position_map) && std::isfinite(p.yaw_rad) &&
         p.position_map.cwiseAbs().maxCoeff() <= 1e6;
}

}  // namespace

Result<Track> Track::create(std::vector<Place> places, bool repeats) {
  Track track;
  const auto wrong = [](const std::string& what) { return fail(ErrorCode::invalid_input, what); };
  if (places.size() < 2) return wrong("a track needs two places or more");
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!is_usable(places[i])) {
      return wrong(
          fmt::format("place {} has a number that is not finite, or lies beyond 1e6 m", i + 1));
    }
    if (i == 0) continue;
    const double dt_s = places[i].t_s - places[i - 1].t_s;
    if (!(dt_s > 0.0)) return wrong(fmt::format("the time of place {} does not rise", i + 1));
    const double speed = (places[i].position_map - places[i - 1].position_map).norm() / dt_s;
    const double turn = std::abs(shorter_turn(places[i - 1].yaw_rad, places[i].yaw_rad)) / dt_s;
    if (!(speed <= kJump_m_s) || !(turn <= kJump_rad_s)) {
      return wrong(fmt::format("the track jumps to place {}: {:.3g} m/s and {:.3g} rad/s", i + 1,
                               speed, turn));
    }
    track.top_speed_m_s_ = std::max(track.top_speed_m_s_, speed);
    track.top_turn_rad_s_ = std::max(track.top_turn_rad_s_, turn);
  }
  const Place& first = places.front();
  const Place& last = places.back();
  const bool returns = (first.position_map - last.position_map).norm() <= kSamePlace_m &&
                       std::abs(shorter_turn(first.yaw_rad, last.yaw_rad)) <= kSameHeading_rad;
  if (repeats && !returns) {
    return wrong("a track that repeats must end at the place and heading of its beginning");
  }
  track.places_ = std::move(places);
  track.repeats_ = repeats;
  return track;
}

BoxState Track::at(double t_s) const {
  const double first = places_.front().t_s, span = places_.back().t_s - first;
  double t = t_s;
  if (repeats_) t = t_s - span * std::floor((t_s - first) / span);
  const auto found = std::ranges::upper_bound(places_, t, {}, &Place::t_s);
  if (found == places_.begin() || found == places_.end()) {
    const Place& end = found == places_.begin() ? places_.front() : places_.back();
    return {.position_map = end.position_map, .q_map_box = from_yaw(end.yaw_rad)};
  }
  const Place& a = *(found - 1);
  const Place& b = *found;
  const double dt_s = b.t_s - a.t_s, part = (t - a.t_s) / dt_s;
  const double turn = shorter_turn(a.yaw_rad, b.yaw_rad);
  const Vec3 way = b.position_map - a.position_map;
  return {a.position_map + part * way, from_yaw(a.yaw_rad + part * turn), way / dt_s,
          Vec3(0.0, 0.0, turn / dt_s)};
}

}  // namespace goshawk::movers
