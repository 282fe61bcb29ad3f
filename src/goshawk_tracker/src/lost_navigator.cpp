#include <algorithm>

#include "clock_time.hpp"
#include "goshawk/tracker/tracker.hpp"

// What the tracker does without a navigator: it holds, then lands where that is known to be safe.

namespace goshawk::tracker {

void Tracker::heard_navigator(std::int64_t now_ns) {
  if (!within_bound(now_ns)) return;
  heard_ns_ = now_ns;
  deserted_ = {ErrorCode::ok, ""};
  stays_ = false;
  if (!landing_) return;
  brake(now_ns);  // it may be needed where it is
  landing_ = false;
}

void Tracker::check_landing(std::int64_t now_ns) {
  if (reference_.at_rest(now_ns)) return;
  const Vec3 place = reference_.at(now_ns).position;
  const Status answer = guard_.check(place);
  if (answer) return;
  brake(now_ns);
  landing_ = false;
  stay(answer.error(), place);
}

void Tracker::watch_navigator(std::int64_t now_ns) {
  const bool rests = reference_.at_rest(now_ns) && queue_.empty();
  if (!rests) rest_since_ns_.reset();
  if (rests && !rest_since_ns_) rest_since_ns_ = now_ns;
  if (!heard_ns_ || seconds(*heard_ns_, now_ns) <= config_.navigator_timeout_s) return;
  if (deserted_.code == ErrorCode::ok) {
    deserted_ = fail(ErrorCode::stage_silent,
                     "the navigator is silent for " + number(config_.navigator_timeout_s) +
                         " s: what is committed is flown to its end and held there; landing " +
                         number(config_.land_after_s) + " s later, where that is free");
  }
  if (landing_ || stays_ || !rests) return;
  if (seconds(std::max(*rest_since_ns_, *heard_ns_), now_ns) >= config_.land_after_s) {
    try_to_land(now_ns);
  }
}

void Tracker::try_to_land(std::int64_t now_ns) {
  const Vec3 place = reference_.at(now_ns).position;
  if (auto answer = guard_.check(place); !answer) return stay(answer.error(), place);
  land(now_ns);
}

// Until another map comes, or the navigator is back.
void Tracker::stay(const Error& why, const Vec3& position_map) {
  stays_ = true;
  deserted_ = fail(why.code, "the navigator is lost, and instead of landing the vehicle holds at " +
                                 to_text(position_map) + " m: " + why.message);
}

// Straight down, at rest at both ends: a quintic's top speed is 15/8 of its mean.
void Tracker::land(std::int64_t now_ns) {
  landing_ = true;
  const FlatState from{.position = reference_.at(now_ns).position};
  FlatState to = from;
  to.position.z() = config_.land_height_m;
  const double height_m = from.position.z() - to.position.z();
  deserted_ = fail(ErrorCode::stage_silent,
                   "the navigator is lost: landing below " + to_text(from.position) + " m");
  if (height_m < 1e-3) return;
  const double duration_s = 15.0 / 8.0 * height_m / config_.land_speed_m_s;
  reference_.leave_by(BezierPiece::between(from, to, duration_s), now_ns);
}

}  // namespace goshawk::tracker
