#include "goshawk/tracker/odometry_clock.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::tracker {
namespace {

// Rounding of stamps, and clocks that are slewed; less is no clock that was set.
constexpr std::int64_t kSlack_ns = 1'000'000;

}  // namespace

OdometryClock::OdometryClock(double longest_age_s)
    : longest_age_ns_(std::llround(longest_age_s * 1e9)) {}

OdometryClock::Reading OdometryClock::read(std::int64_t stamp_ns, std::int64_t wall_ns,
                                           std::int64_t now_ns) {
  const std::int64_t wall_age_ns = wall_ns - stamp_ns;
  const bool wall_tells = wall_age_ns >= -kSlack_ns && wall_age_ns <= longest_age_ns_;
  if (!last_ || now_ns < last_->now_ns) {
    // Clocks of two hosts that do not agree tell no age: then it has just been made.
    usual_age_ns_ = wall_tells ? std::max<std::int64_t>(wall_age_ns, 0) : 0;
    offset_ns_ = now_ns - usual_age_ns_ - stamp_ns;
    last_ = Last{stamp_ns, now_ns};
    return {now_ns - usual_age_ns_, 0.0};
  }
  std::int64_t age_ns = now_ns - (stamp_ns + offset_ns_);
  const bool from_the_future = age_ns < -kSlack_ns;
  const bool out_of_order = stamp_ns < last_->stamp_ns - kSlack_ns;
  // After a pause a clock that was set back looks like a measurement that was late. Where both
  // clocks were set alike, their difference still tells the age.
  const bool both_set = age_ns > longest_age_ns_ && wall_tells;
  last_ = Last{stamp_ns, now_ns};
  Reading reading;
  if (from_the_future || out_of_order || both_set) {
    reading.set_by_s = double(usual_age_ns_ - age_ns) * 1e-9;
    age_ns = usual_age_ns_;
    offset_ns_ = now_ns - age_ns - stamp_ns;
  }
  age_ns = std::max<std::int64_t>(age_ns, 0);
  if (age_ns <= longest_age_ns_) usual_age_ns_ = age_ns;
  reading.time_ns = now_ns - age_ns;
  return reading;
}

}  // namespace goshawk::tracker
