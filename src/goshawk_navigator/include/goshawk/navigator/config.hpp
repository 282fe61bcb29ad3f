#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/core/plan_request.hpp"

namespace goshawk::navigator {

struct Config {
  double v_max_m_s = 2.0;
  double a_max_m_s2 = 2.0;
  LimitNorm limit_norm = LimitNorm::euclidean;
  double j_max_m_s3 = 0.0;
  double j_max_in_flight_m_s3 = 20.0;  // of plans from a moving start
  double v_max_vertical_m_s = 0.0;
  double a_max_vertical_m_s2 = 0.0;
  UnknownSpace unknown = UnknownSpace::as_configured;
  double plan_timeout_s = 1.0;
  int max_attempts = 5;
  double replan_lead_s = 0.3;
  double commit_lead_s = 0.05;
  double arrival_tolerance_m = 0.1;
  double rest_speed_m_s = 0.15;
  double settle_timeout_s = 5.0;
  double odometry_timeout_s = 0.5;
  bool require_map = true;
  bool fly_unknown = false;
  double map_wait_s = 0.5;
  double map_retry_s = 5.0;
  double operator_speed_m_s = 0.5;  // of landings and takeoffs
  std::string memory_file;

  Limits limits() const {
    return {.v_max_m_s = v_max_m_s,
            .a_max_m_s2 = a_max_m_s2,
            .norm = limit_norm,
            .j_max_m_s3 = j_max_m_s3,
            .v_max_vertical_m_s = v_max_vertical_m_s,
            .a_max_vertical_m_s2 = a_max_vertical_m_s2};
  }
  /// Of a plan from a moving start. It may turn from one full acceleration to the opposite one, and
  /// without a limit does so faster than the vehicle can tilt.
  Limits limits_in_flight() const {
    Limits limits = this->limits();
    const bool tighter = limits.j_max_m_s3 > 0.0 && limits.j_max_m_s3 <= j_max_in_flight_m_s3;
    if (!tighter && j_max_in_flight_m_s3 > 0.0) limits.j_max_m_s3 = j_max_in_flight_m_s3;
    return limits;
  }
};

namespace detail {

template <typename Self, typename Visitor>
void describe_request(Self& c, Visitor& visit) {
  visit("v_max_m_s", c.v_max_m_s, "m/s", "speed limit of every plan",
        AtRunTime{Range::positive(100.0)});
  visit("a_max_m_s2", c.a_max_m_s2, "m/s^2", "acceleration limit of every plan",
        AtRunTime{Range::positive(100.0)});
  visit("limit_norm", c.limit_norm, "",
        "what the limits bound: the Euclidean length, each component, or the horizontal length and "
        "the vertical component apart",
        AtRunTime{Anything{}});
  visit("j_max_m_s3", c.j_max_m_s3, "m/s^3", "limit of the jerk's Euclidean length; 0: none",
        AtRunTime{Range{0.0, 1e4}});
  visit("j_max_in_flight_m_s3", c.j_max_in_flight_m_s3, "m/s^3",
        "the same for plans from a moving start, if lower: so that the tracking error stays within "
        "the margin in every turn; 0: j_max_m_s3 alone",
        AtRunTime{Range{0.0, 1e4}});
  visit("v_max_vertical_m_s", c.v_max_vertical_m_s, "m/s",
        "vertical speed limit, with limit_norm horizontal_vertical; 0: v_max_m_s",
        AtRunTime{Range{0.0, 100.0}});
  visit("a_max_vertical_m_s2", c.a_max_vertical_m_s2, "m/s^2",
        "vertical acceleration limit, with limit_norm horizontal_vertical; 0: a_max_m_s2",
        AtRunTime{Range{0.0, 100.0}});
  visit("unknown", c.unknown, "",
        "how the search takes space that was never measured: as_configured (its own parameter), "
        "blocked, free or costly; the last two need a map that leaves it free (map_server: "
        "unknown: free)",
        AtRunTime{Anything{}});
}

template <typename Self, typename Visitor>
void describe_map(Self& c, Visitor& visit) {
  visit("require_map", c.require_map, "",
        "only what the map shows free is committed; false: before any map came, trajectories are "
        "committed unchecked",
        Anything{});
  visit("fly_unknown", c.fly_unknown, "",
        "if the map leaves unknown space free, it is flown through as if it were free; false: what "
        "leads through it gets a stop part that is flown only through space in which the whole "
        "body was seen to be free",
        Anything{});
  visit("map_wait_s", c.map_wait_s, "s",
        "how long a trajectory waits for the map version that it names, before it is refused",
        AtRunTime{Range{0.0, 60.0}});
  visit("map_retry_s", c.map_retry_s, "s",
        "how long a goal that failed because of the map is planned for again when the map changes",
        AtRunTime{Range{0.0, 3600.0}});
}

}  // namespace detail

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  detail::describe_request(c, visit);
  visit("plan_timeout_s", c.plan_timeout_s, "s", "a plan that takes longer is requested again",
        AtRunTime{Range{0.01, 600.0}});
  visit("max_attempts", c.max_attempts, "",
        "how often a plan may fail for a reason that time can mend before the goal is given up",
        AtRunTime{Range{1, 100}});
  visit("replan_lead_s", c.replan_lead_s, "s",
        "a plan from a moving start begins this far ahead on the present trajectory",
        AtRunTime{Range{0.02, 10.0}});
  visit("commit_lead_s", c.commit_lead_s, "s",
        "a plan from rest starts this long after it arrives, and 0.3 s later after each trajectory "
        "in a row that the tracker did not fly",
        AtRunTime{Range{0.0, 10.0}});
  visit("arrival_tolerance_m", c.arrival_tolerance_m, "m",
        "a vehicle this near to the goal has arrived", AtRunTime{Range::positive(10.0)});
  visit("rest_speed_m_s", c.rest_speed_m_s, "m/s", "a vehicle slower than this is at rest",
        Range::positive(10.0));
  visit("settle_timeout_s", c.settle_timeout_s, "s",
        "how long a plan waits for odometry and for the vehicle to come to rest",
        AtRunTime{Range::positive(600.0)});
  visit("odometry_timeout_s", c.odometry_timeout_s, "s", "odometry older than this is not used",
        Range::positive(60.0));
  detail::describe_map(c, visit);
  visit("operator_speed_m_s", c.operator_speed_m_s, "m/s",
        "speed limit of the landings and takeoffs that an operator commands, if lower than "
        "v_max_m_s",
        AtRunTime{Range::positive(100.0)});
  visit("memory_file", c.memory_file, "",
        "file that keeps the goal and what is flown, so that a restarted navigator goes on with "
        "them; a launch sets it; empty: none",
        Anything{});
}

}  // namespace goshawk::navigator
