#include "goshawk/core/brake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "slowing.hpp"

namespace goshawk {
namespace {

constexpr double kRamp_s = 0.3;  // of the deceleration, to its full value and back
constexpr std::array kSlower{1.0, 1.25, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0};

}  // namespace

Result<CertifiedTrajectory> brake_along(const CommittedTrajectory& committed, double from_s,
                                        const std::function<bool(const Trajectory&)>& is_free) {
  const SlowedPath path(committed.flown(), from_s);
  const Limits& limits = committed.nominal().limits();
  const double gentle_s = std::max(kRamp_s, path.start().velocity.norm() / limits.a_max_m_s2);
  for (const double slower : kSlower) {
    const TimeLaw law(slower * gentle_s, kRamp_s);
    if (law.passes_s() >= path.left_s()) break;
    Trajectory trajectory = path.by(law);
    if (!is_free(trajectory)) continue;
    auto certified = certify_slowed(path, law, std::move(trajectory), committed.flown_polytopes(),
                                    from_s, limits);
    if (certified) return certified;
  }
  return fail(ErrorCode::trajectory_infeasible,
              fmt::format("trajectory {} cannot be braked along its path {:.3g} s after its start: "
                          "it ends as soon by itself, or is at its limits there",
                          committed.id(), from_s));
}

}  // namespace goshawk
