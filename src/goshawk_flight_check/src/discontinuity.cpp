#include "goshawk/flight_check/discontinuity.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace goshawk::flight_check {

std::optional<std::string> discontinuity(const LiveSample& from, const LiveSample& to) {
  const double gap_s = to.sample.t_s - from.sample.t_s;
  if (gap_s < 0.0) {
    return fmt::format("odometry's clock went back by {:.3f} s", -gap_s);
  }
  if (gap_s > kLongestGap_s) {
    return fmt::format("no odometry came for {:.2f} s", gap_s);
  }
  const Vec3& p = to.sample.position_map;
  const double jump_m = (p - from.sample.position_map).norm();
  // Twice the larger speed: generous for any vehicle within a gap of half a second.
  const double reach_m = kNoise_m + 2.0 * std::max(from.speed_m_s, to.speed_m_s) * gap_s;
  if (jump_m <= reach_m) return std::nullopt;
  return fmt::format("odometry jumped by {:.2f} m within {:.3f} s, to ({:.2f}, {:.2f}, {:.2f})",
                     jump_m, gap_s, p.x(), p.y(), p.z());
}

}  // namespace goshawk::flight_check
