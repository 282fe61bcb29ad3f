#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/limits.hpp"
#include "goshawk/core/parameter.hpp"

namespace goshawk::guard {

struct Config {
  double v_max_m_s = 2.0;
  double a_max_m_s2 = 2.0;
  double j_max_m_s3 = 20.0;
  LimitNorm limit_norm = LimitNorm::euclidean;
  double lead_s = 0.05;
  double join_within_m = 1.0;
  double follow_within_m = 0.3;
  double plan_timeout_s = 2.0;
  bool repair = true;
  bool fly_unknown = false;

  Limits limits() const {
    return {.v_max_m_s = v_max_m_s,
            .a_max_m_s2 = a_max_m_s2,
            .norm = limit_norm,
            .j_max_m_s3 = j_max_m_s3};
  }
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("v_max_m_s", c.v_max_m_s, "m/s", "speed limit of everything that is flown",
        AtRunTime{Range::positive(100.0)});
  visit("a_max_m_s2", c.a_max_m_s2, "m/s^2", "acceleration limit of everything that is flown",
        AtRunTime{Range::positive(100.0)});
  visit("j_max_m_s3", c.j_max_m_s3, "m/s^3",
        "limit of the jerk's Euclidean length, so that the tracking error stays within the margin; "
        "0: none",
        AtRunTime{Range{0.0, 1e4}});
  visit("limit_norm", c.limit_norm, "",
        "what v_max and a_max bound: the Euclidean length, each component, or the horizontal "
        "length and the vertical component apart",
        AtRunTime{Anything{}});
  visit("lead_s", c.lead_s, "s", "a plan is joined this long after it arrives, or later",
        AtRunTime{Range{0.01, 1.0}});
  visit("join_within_m", c.join_within_m, "m",
        "a plan that is farther than this from where the vehicle will be is refused",
        AtRunTime{Range::positive(100.0)});
  visit("follow_within_m", c.follow_within_m, "m",
        "how far a replaced plan may lead the vehicle away from the planned curve",
        AtRunTime{Range{0.05, 10.0}});
  visit("plan_timeout_s", c.plan_timeout_s, "s",
        "a planner that was flying the vehicle and sends nothing for this long is reported; 0: "
        "never",
        AtRunTime{Range{0.0, 3600.0}});
  visit("repair", c.repair, "",
        "plans that cannot be flown as they are get another trajectory along the same curve; "
        "false: they are refused",
        AtRunTime{Anything{}});
  visit("fly_unknown", c.fly_unknown, "",
        "if the map leaves unknown space free, it is flown through as if it were free; false: a "
        "stop part ends every plan before space in which the whole body was not seen to be free",
        Anything{});
}

}  // namespace goshawk::guard
