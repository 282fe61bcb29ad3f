#include "goshawk/trajectory_optimizer/request_check.hpp"

#include <cmath>
#include <cstdio>
#include <string>

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kPlace = 1e-6;         // [m] how well the ends must agree with the corridor
constexpr double kFarthest = 1e6;       // [m] beyond, a double cannot resolve the certificate
constexpr double kLeastOverlap = 1e-5;  // [m] less is no room for a joint

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

constexpr double kMostExcess = 5.0;  // of a limit: beyond, the start is a mistake

Status check_limits(const Limits& limits) {
  if (auto status = limits.check(); !status) return status;
  for (const double limit : {limits.v_max_m_s, limits.a_max_m_s2, limits.j_max_m_s3,
                             limits.v_max_vertical_m_s, limits.a_max_vertical_m_s2}) {
    if (limit != 0.0 && (limit < 1e-3 || limit > 1e6)) {
      return fail(ErrorCode::invalid_limits,
                  "a limit of " + number(limit) + " is outside 0.001 to 1000000: check its unit");
    }
  }
  return success();
}

Status check_places(const Corridor& corridor) {
  for (std::size_t k = 0; k < corridor.waypoints_map.size(); ++k) {
    const Vec3& waypoint = corridor.waypoints_map[k];
    // Not by maxCoeff() alone, which may pass over a NaN.
    if (!is_finite(waypoint) || waypoint.cwiseAbs().maxCoeff() > kFarthest) {
      return fail(ErrorCode::invalid_input,
                  "waypoint " + std::to_string(k) + " " + to_text(waypoint) +
                      " is not finite or farther than 1000 km from the origin of the map");
    }
  }
  return success();
}

Status check_overlaps(const Corridor& corridor) {
  for (std::size_t k = 0; k < corridor.overlaps.size(); ++k) {
    const Ball& ball = corridor.overlaps[k];
    const std::string pair = "polytopes " + std::to_string(k) + " and " + std::to_string(k + 1);
    if (!(ball.radius_m >= kLeastOverlap)) {
      return fail(ErrorCode::corridor_disjoint,
                  pair + " share a ball of radius " + number(ball.radius_m) +
                      " m: a joint needs room, let them overlap more");
    }
    for (const std::size_t side : {k, k + 1}) {
      if (!is_finite(ball.center_map) ||
          !(corridor.polytopes[side].violation(ball.center_map) <= -0.5 * kLeastOverlap)) {
        return fail(ErrorCode::corridor_disjoint,
                    "the overlap stated for " + pair + " at " + to_text(ball.center_map) +
                        " is not inside polytope " + std::to_string(side));
      }
    }
  }
  if (corridor.polytopes.size() == 1) {
    const double radius = chebyshev_ball(corridor.polytopes.front()).radius_m;
    if (!(radius >= kLeastOverlap)) {
      return fail(ErrorCode::invalid_input, "the only polytope holds a ball of radius " +
                                                number(radius) + " m: it has no interior");
    }
  }
  return success();
}

Status check_end(const char* name, ErrorCode code, const FlatState& state, const Vec3& waypoint,
                 const Limits& limits, double most) {
  if (!is_finite(state.position) || !is_finite(state.velocity) || !is_finite(state.acceleration)) {
    return fail(ErrorCode::invalid_input, std::string("the ") + name + " state is not finite");
  }
  if (!((state.position - waypoint).norm() <= kPlace)) {
    return fail(code, std::string("the ") + name + " " + to_text(state.position) +
                          " is not the corridor's end " + to_text(waypoint) +
                          ": build the corridor from the same state");
  }
  const auto within = [&](const char* what, double usage, double limit, const char* unit) {
    if (usage <= most + 1e-6 / limit) return success();
    return Status(fail(code, std::string("the ") + name + " " + what + " of " +
                                 number(usage * limit) + " " + unit + " is above " +
                                 number(most * limit) + " " + unit +
                                 ": slow down first or raise the limit"));
  };
  if (auto status = within("speed", limits.speed_usage(state.velocity), limits.v_max_m_s, "m/s");
      !status) {
    return status;
  }
  return within("acceleration", limits.acceleration_usage(state.acceleration), limits.a_max_m_s2,
                "m/s^2");
}

}  // namespace

Status check_request(const Corridor& corridor, const FlatState& start, const FlatState& goal,
                     const Limits& limits) {
  if (auto status = check_limits(limits); !status) return status;
  if (auto status = corridor.check(); !status) return status;
  if (auto status = check_places(corridor); !status) return status;
  if (auto status = check_overlaps(corridor); !status) return status;
  if (auto status = check_end("start", ErrorCode::start_infeasible, start,
                              corridor.waypoints_map.front(), limits, kMostExcess);
      !status) {
    return status;
  }
  return check_end("goal", ErrorCode::invalid_input, goal, corridor.waypoints_map.back(), limits,
                   1.0);
}

}  // namespace goshawk::trajectory_optimizer
