#include "goshawk/trajectory_optimizer/request_check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kPlace = 1e-6;         // [m] how well the ends must agree with the corridor
constexpr double kFarthest = 1e6;       // [m] beyond, a double cannot resolve the certificate
constexpr double kLeastOverlap = 1e-5;  // [m] less is no room to change the polytope in
constexpr double kMostExcess = 5.0;     // of a limit: beyond, the start is a mistake
constexpr double kLeastLimit = 1e-3;
constexpr double kMostLimit = 1e6;
constexpr double kLongest_s = 1e6;  // of a given duration

Status check_limits(const Limits& limits) {
  for (const double limit : {limits.v_max_m_s, limits.a_max_m_s2, limits.j_max_m_s3,
                             limits.v_max_vertical_m_s, limits.a_max_vertical_m_s2}) {
    if (limit == 0.0 || (limit >= kLeastLimit && limit <= kMostLimit)) continue;
    return fail(ErrorCode::invalid_limits,
                fmt::format("a limit of {:.6g} is outside {} to {}: check its unit", limit,
                            kLeastLimit, kMostLimit));
  }
  return success();
}

Status check_places(const Corridor& corridor) {
  for (std::size_t k = 0; k < corridor.waypoints_map.size(); ++k) {
    const Vec3& waypoint = corridor.waypoints_map[k];
    // Not by maxCoeff() alone, which may pass over a NaN.
    if (is_finite(waypoint) && waypoint.cwiseAbs().maxCoeff() <= kFarthest) continue;
    return fail(ErrorCode::invalid_input,
                fmt::format("waypoint {} {} is not finite or more than 1000 km from the map's "
                            "origin",
                            k, to_text(waypoint)));
  }
  return success();
}

Status check_overlap(const Corridor& corridor, std::size_t k) {
  const Ball& ball = corridor.overlaps[k];
  if (!(ball.radius_m >= kLeastOverlap)) {
    return fail(ErrorCode::corridor_disjoint,
                fmt::format("polytopes {} and {} share a ball of {:.3g} m radius, too small to "
                            "change from one to the other: let them overlap more",
                            k, k + 1, ball.radius_m));
  }
  for (const std::size_t side : {k, k + 1}) {
    if (is_finite(ball.center_map) &&
        corridor.polytopes[side].violation(ball.center_map) <= -0.5 * kLeastOverlap) {
      continue;
    }
    return fail(ErrorCode::corridor_disjoint,
                fmt::format("the overlap given for polytopes {} and {}, around {}, is not inside "
                            "polytope {}",
                            k, k + 1, to_text(ball.center_map), side));
  }
  return success();
}

Status check_overlaps(const Corridor& corridor) {
  for (std::size_t k = 0; k < corridor.overlaps.size(); ++k) {
    if (auto status = check_overlap(corridor, k); !status) return status;
  }
  if (corridor.polytopes.size() > 1) return success();
  const double radius = chebyshev_ball(corridor.polytopes.front()).radius_m;
  if (radius >= kLeastOverlap) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("the corridor's only polytope has no interior: the largest ball in it "
                          "has a radius of {:.3g} m",
                          radius));
}

Status check_duration(double duration_s) {
  if (duration_s <= kLongest_s) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("a duration of {:.4g} s is out of range: ask for up to {:g} s, or for 0 to "
                          "arrive as soon as the limits allow",
                          duration_s, kLongest_s));
}

struct End {
  std::string_view name;
  ErrorCode code;  // of a state that does not fit
  const FlatState& state;
  const Vec3& waypoint;
  double most;  // of a limit
};

Status check_usage(const End& end, std::string_view what, double usage, double limit,
                   std::string_view unit) {
  if (usage <= end.most + 1e-6 / limit) return success();
  return fail(end.code, fmt::format("the {}'s {} of {:.4g} {} is above {:.4g} {}: slow down first "
                                    "or raise the limit",
                                    end.name, what, usage * limit, unit, end.most * limit, unit));
}

Status check_end(const End& end, const Limits& limits) {
  const FlatState& state = end.state;
  if (!((state.position - end.waypoint).norm() <= kPlace)) {
    return fail(end.code, fmt::format("the {} {} is not the corridor's end {}: build the corridor "
                                      "from the same state",
                                      end.name, to_text(state.position), to_text(end.waypoint)));
  }
  if (auto status =
          check_usage(end, "speed", limits.speed_usage(state.velocity), limits.v_max_m_s, "m/s");
      !status) {
    return status;
  }
  return check_usage(end, "acceleration", limits.acceleration_usage(state.acceleration),
                     limits.a_max_m_s2, "m/s^2");
}

}  // namespace

Status check_request(const PlanRequest& request, const Corridor& corridor) {
  if (auto status = check(request); !status) return status;
  if (auto status = check_limits(request.limits); !status) return status;
  if (auto status = check_duration(request.duration_s); !status) return status;
  if (auto status = corridor.check(); !status) return status;
  if (auto status = check_places(corridor); !status) return status;
  if (auto status = check_overlaps(corridor); !status) return status;
  const auto& waypoints = corridor.waypoints_map;
  const End start{"start", ErrorCode::start_infeasible, request.start, waypoints.front(),
                  kMostExcess};
  const End goal{"goal", ErrorCode::invalid_input, request.goal, waypoints.back(), 1.0};
  if (auto status = check_end(start, request.limits); !status) return status;
  return check_end(goal, request.limits);
}

}  // namespace goshawk::trajectory_optimizer
