#include "goshawk/core/plan_request.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace goshawk {
namespace {

Status check_state(const char* name, const FlatState& s) {
  if (s.is_finite()) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("the {} state of a plan request is not finite: position {}, velocity {}, "
                          "acceleration {}",
                          name, to_text(s.position), to_text(s.velocity), to_text(s.acceleration)));
}

Status check_angle(const char* name, double value) {
  if (std::isfinite(value)) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("the {} of a plan request is {}: it must be finite", name, value));
}

Status check_time(const char* name, double value_s, const char* zero) {
  if (std::isfinite(value_s) && value_s >= 0.0) return success();
  return fail(
      ErrorCode::invalid_input,
      fmt::format("the {} of a plan request is {:.3g} s: use 0 ({}) or more", name, value_s, zero));
}

}  // namespace

Status check(const PlanRequest& request) {
  if (auto s = check_state("start", request.start); !s) return s;
  if (auto s = check_state("goal", request.goal); !s) return s;
  for (std::size_t k = 0; k < request.other_goals_map.size(); ++k) {
    if (request.other_goals_map[k].allFinite()) continue;
    return fail(ErrorCode::invalid_input,
                fmt::format("other goal {} of a plan request is not finite: {}", k,
                            to_text(request.other_goals_map[k])));
  }
  if (auto s = check_angle("goal's yaw", request.goal_yaw_rad); !s) return s;
  if (auto s = check_angle("start's yaw", request.start_yaw_rad); !s) return s;
  if (auto s = check_angle("start's yaw rate", request.start_yaw_rate_rad_s); !s) return s;
  if (auto s = check_time("deadline", request.deadline_s, "none"); !s) return s;
  if (auto s = check_time("duration", request.duration_s, "as fast as the limits allow"); !s) {
    return s;
  }
  return request.limits.check();
}

Status check_deadline(const PlanRequest& request, std::int64_t now_ns) {
  if (request.deadline_s == 0.0) return success();
  const double late_s = double(now_ns - request.stamp_ns) * 1e-9 - request.deadline_s;
  if (late_s <= 0.0) return success();
  return fail(
      ErrorCode::deadline_exceeded,
      fmt::format("the request's deadline of {:.3g} s passed {:.3g} s ago: allow more time, "
                  "or give the machine less to do",
                  request.deadline_s, late_s));
}

}  // namespace goshawk
