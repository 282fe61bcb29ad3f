#include <sys/timex.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "goshawk/introspection/doctor.hpp"

namespace goshawk::introspection {
namespace {

constexpr double kNoEarlier_s = 1'767'225'600;  // 2026-01-01: no flight was before
constexpr double kJump_s = 0.02;  // more than a daemon slews or a busy machine delays in that time
constexpr double kFuture_s = 0.002;  // no message comes before it was stamped
constexpr double kOld_s = 5.0;       // older only if clocks differ

double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// The tightest of a few readings: one that was interrupted does not count.
double real_minus_monotonic_s() {
  double best_s = 0.0;
  double least_s = 1e9;
  for (int k = 0; k < 5; ++k) {
    const double before_s = seconds(CLOCK_MONOTONIC);
    const double real_s = seconds(CLOCK_REALTIME);
    const double after_s = seconds(CLOCK_MONOTONIC);
    if (after_s - before_s >= least_s) continue;
    least_s = after_s - before_s;
    best_s = real_s - 0.5 * (before_s + after_s);
  }
  return best_s;
}

std::string milliseconds(double time_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f ms", time_s * 1e3);
  return text;
}

Finding check_clock() {
  if (seconds(CLOCK_REALTIME) < kNoEarlier_s) {
    return {"clock", Level::warning, "is before 2026", "messages and files get wrong times",
            "set it: date -s, or run chrony"};
  }
  timex state{};
  const bool synchronised = adjtimex(&state) != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
  if (synchronised) return {"clock", Level::fine, "is synchronised"};
  return {"clock", Level::note, "is not synchronised",
          "harmless on one machine; stages on several machines compare their stamps", "run chrony"};
}

}  // namespace

ClockWatch::ClockWatch() : offset_s_(real_minus_monotonic_s()) {}

std::vector<Finding> ClockWatch::findings() const {
  return {check_clock(), check_clock_jump(real_minus_monotonic_s() - offset_s_)};
}

Finding check_clock_jump(double jump_s) {
  if (std::abs(jump_s) < kJump_s)
    return {"clock's pace", Level::fine, "did not jump while it was watched"};
  return {"clock's pace", Level::warning,
          "the clock was set by " + milliseconds(jump_s) + " while it was watched",
          "stamps before and after cannot be compared: odometry seems old, or from the future",
          "let only one daemon set it, by slewing instead of stepping (chrony, makestep off)"};
}

Finding check_stamps(const std::string& topic, const std::vector<double>& ages_s) {
  // The youngest one counts: delays only add to the age.
  const double age_s = *std::ranges::min_element(ages_s);
  const std::string about = "stamps of " + topic;
  if (age_s < -kFuture_s) {
    return {about, Level::warning, "are " + milliseconds(-age_s) + " in the future",
            "its sender's clock is ahead of this one: the tracker refuses such odometry",
            "run chrony on both machines, or set use_sim_time if the sender simulates"};
  }
  if (age_s > kOld_s) {
    return {about, Level::warning, "are " + milliseconds(age_s) + " old",
            "its sender's clock is behind this one, or has another epoch",
            "run chrony on both machines, or set use_sim_time if the sender simulates"};
  }
  return {about, Level::fine, "are " + milliseconds(std::max(0.0, age_s)) + " old on arrival"};
}

}  // namespace goshawk::introspection
