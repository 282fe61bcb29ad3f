#include "plan_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace goshawk::flight_report {
namespace {

struct Part {
  Trajectory trajectory;
  double duration_s;
};

/// What was followed of each trajectory. Those that a newer one replaced at once are left out.
std::vector<Part> followed(const Flight& flight) {
  std::vector<Part> parts;
  double next_s = std::numeric_limits<double>::infinity();
  for (auto leg = flight.legs.rbegin(); leg != flight.legs.rend(); ++leg) {
    if (leg->trajectory.pieces.empty()) continue;
    const double whole_s = leg->trajectory.duration_s(), most_s = next_s - leg->start_t_s;
    next_s = std::min(next_s, leg->start_t_s);
    if (most_s <= 0.0) continue;
    parts.push_back(most_s < whole_s ? Part{leg->trajectory.until(most_s), most_s}
                                     : Part{leg->trajectory, whole_s});
  }
  return parts;
}

}  // namespace

std::string plan_summary(const Flight& flight) {
  double length_m = 0.0, duration_s = 0.0, top_m_s = 0.0;
  for (const Part& part : followed(flight)) {
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
