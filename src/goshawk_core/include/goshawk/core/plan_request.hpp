#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "goshawk/core/limits.hpp"

namespace goshawk {

/// How a plan takes space that was never measured.
enum class UnknownSpace { as_configured, blocked, free, costly };
constexpr auto words_of(UnknownSpace) {
  using enum UnknownSpace;
  return std::to_array<Named<UnknownSpace>>(
      {{as_configured, "as_configured"}, {blocked, "blocked"}, {free, "free"}, {costly, "costly"}});
}

/// One plan that is asked for. Frame `map`.
struct PlanRequest {
  std::uint64_t id = 0;                            // unique to the asker, above 0
  std::int64_t stamp_ns = 0;                       // when it was asked; in a stage: first heard of
  std::optional<std::int64_t> start_time_ns = {};  // when the vehicle will be in `start`; none: at
                                                   // rest, whenever
  FlatState start;                                 // its jerk is not used
  double start_yaw_rad = 0.0;                      // from x to y
  double start_yaw_rate_rad_s = 0.0;
  FlatState goal;                          // its jerk is not used
  std::vector<Vec3> other_goals_map = {};  // [m] positions that will do as well as goal's
  double goal_yaw_rad = 0.0;
  Limits limits;
  double deadline_s = 0.0;       // [s] after the stamp; 0: none
  double duration_s = 0.0;       // [s] of the flight; 0: as fast as the limits allow
  std::uint64_t supersedes = 0;  // the request that this one makes obsolete; 0: none
  UnknownSpace unknown = UnknownSpace::as_configured;
};

/// @return invalid_input (not finite, or a deadline or duration below zero) or invalid_limits
Status check(const PlanRequest& request);

/// @return deadline_exceeded if the request's deadline lies before now
Status check_deadline(const PlanRequest& request, std::int64_t now_ns);

}  // namespace goshawk
