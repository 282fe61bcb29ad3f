#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/parameter.hpp"

namespace goshawk::navigator {

struct Config {
  double v_max_m_s = 2.0;
  double a_max_m_s2 = 2.0;
  std::string limit_norm = "euclidean";
  double plan_timeout_s = 1.0;
  int max_attempts = 5;
  double replan_lead_s = 0.3;
  double commit_lead_s = 0.05;
  double arrival_tolerance_m = 0.1;
  double rest_speed_m_s = 0.15;
  double settle_timeout_s = 5.0;
  double odometry_timeout_s = 0.5;

  Limits limits() const {
    return {v_max_m_s, a_max_m_s2,
            limit_norm == "euclidean" ? LimitNorm::euclidean : LimitNorm::per_axis};
  }
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("v_max_m_s", c.v_max_m_s, "m/s", "speed limit of every plan",
        AtRunTime{Range::positive(100.0)});
  visit("a_max_m_s2", c.a_max_m_s2, "m/s^2", "acceleration limit of every plan",
        AtRunTime{Range::positive(100.0)});
  visit("limit_norm", c.limit_norm, "",
        "what the limits bound: the Euclidean length, or each component",
        AtRunTime{OneOf{{"euclidean", "per_axis"}}});
  visit("plan_timeout_s", c.plan_timeout_s, "s", "a plan that takes longer is asked for again",
        AtRunTime{Range{0.01, 600.0}});
  visit("max_attempts", c.max_attempts, "", "how often a plan is asked for before giving up",
        AtRunTime{Range{1, 100}});
  visit("replan_lead_s", c.replan_lead_s, "s",
        "a plan from a moving start begins this far ahead on the present trajectory",
        AtRunTime{Range{0.02, 10.0}});
  visit("commit_lead_s", c.commit_lead_s, "s", "a plan from rest starts this long after it came",
        AtRunTime{Range{0.0, 10.0}});
  visit("arrival_tolerance_m", c.arrival_tolerance_m, "m", "this near to the goal is arrived",
        AtRunTime{Range::positive(10.0)});
  visit("rest_speed_m_s", c.rest_speed_m_s, "m/s", "slower than this is at rest",
        Range::positive(10.0));
  visit("settle_timeout_s", c.settle_timeout_s, "s",
        "how long a plan waits for odometry and for the vehicle to come to rest",
        AtRunTime{Range::positive(600.0)});
  visit("odometry_timeout_s", c.odometry_timeout_s, "s", "older odometry is none",
        Range::positive(60.0));
}

}  // namespace goshawk::navigator
