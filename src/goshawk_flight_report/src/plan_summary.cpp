#include "plan_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace goshawk::flight_report {
std::string plan_summary(const Flight& flight) {
  double length_m = 0.0, duration_s = 0.0, top_m_s = 0.0;
  for (const FollowedLeg& part : flight.followed()) {
    length_m += part.trajectory.length_m();
    duration_s += part.duration_s;
    top_m_s = std::max(top_m_s, part.trajectory.peaks().speed_m_s);
  }
  if (duration_s <= 0.0) return {};
  return fmt::format(
      "planned {:.2f} m in {:.2f} s, mean {:.2f} m/s, top {:.2f} m/s (limits {:.4g} m/s, {:.4g} "
      "m/s\u00b2)",
      length_m, duration_s, length_m / duration_s, top_m_s, flight.limits.v_max_m_s,
      flight.limits.a_max_m_s2);
}

}  // namespace goshawk::flight_report
