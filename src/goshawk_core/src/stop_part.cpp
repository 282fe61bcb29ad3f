#include "goshawk/core/stop_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "goshawk/core/free_curve.hpp"
#include "slowing.hpp"

namespace goshawk {
namespace {

constexpr double kGentleRamp_s = 0.3;
constexpr double kShortestRamp_s = 0.08;
constexpr double kEarliest_s = 1e-3;  // after from_s: a stop part begins after the nominal part
// The slowed quintics leave the path by less than a micrometre: they end so much sooner.
constexpr double kSpare_s = 1e-5;
constexpr std::array kWeaker{1.0, 1.1, 1.25, 1.6, 2.0, 3.0};
constexpr int kSamples = 12;

/// One way to brake: how fast at the most, as a share of what the limits allow.
struct Way {
  double weaker;
  double ramp_s;

  TimeLaw law(double speed_m_s, const Limits& limits) const {
    return {weaker * std::max(ramp_s, speed_m_s / limits.a_max_m_s2), ramp_s};
  }
};

/// Ways to brake, from the hardest to the gentlest.
std::vector<Way> ways_to_brake(const Limits& limits) {
  std::vector<Way> ways;
  const double hard_s =
      limits.j_max_m_s3 > 0.0
          ? std::clamp(1.2 * limits.a_max_m_s2 / limits.j_max_m_s3, kShortestRamp_s, kGentleRamp_s)
          : kGentleRamp_s;
  for (const double weaker : kWeaker) {
    ways.push_back({weaker, hard_s});
    if (hard_s < kGentleRamp_s) ways.push_back({weaker, kGentleRamp_s});
  }
  return ways;
}

class LatestStop {
 public:
  LatestStop(const CertifiedTrajectory& nominal, const FreeSpace& space, double free_until_s)
      : nominal_(nominal),
        space_(space),
        until_s_(std::min(free_until_s, nominal.duration_s()) - kSpare_s),
        ways_(ways_to_brake(nominal.limits())) {}

  std::optional<StopPart> find(double from_s) const {
    double latest_s = -1.0;
    for (const Way& way : ways_) latest_s = std::max(latest_s, last_moment(way, from_s));
    for (double t_s = latest_s; t_s > from_s + kEarliest_s; t_s -= kStopStep_s) {
      if (auto stop = at(t_s)) return stop;
    }
    return {};
  }

 private:
  double rests_at(const Way& way, double t_s) const {
    const double speed_m_s = nominal_.trajectory().sample(t_s).velocity.norm();
    return t_s + way.law(speed_m_s, nominal_.limits()).passes_s();
  }

  // When this way must begin, by bisection: within its limits the nominal part's speed does not
  // fall so fast that a later stop would end sooner.
  double last_moment(const Way& way, double from_s) const {
    double low = from_s, high = until_s_;
    if (high <= low || rests_at(way, low) > until_s_) return -1.0;
    while (high - low > 0.1 * kStopStep_s) {
      const double middle = 0.5 * (low + high);
      (rests_at(way, middle) <= until_s_ ? low : high) = middle;
    }
    return low;
  }

  std::optional<StopPart> at(double t_s) const {
    const SlowedPath path(nominal_.trajectory(), t_s);
    const double speed_m_s = path.start().velocity.norm();
    for (const Way& way : ways_) {
      const TimeLaw law = way.law(speed_m_s, nominal_.limits());
      if (t_s + law.passes_s() > until_s_ || !may_hold(path, law)) continue;
      Trajectory slowed = path.by(law, true);
      if (find_obstruction(space_, slowed)) continue;
      auto certified = certify_slowed(path, law, std::move(slowed), nominal_.polytopes(), t_s,
                                      nominal_.limits());
      if (certified) return StopPart{t_s, *std::move(certified)};
    }
    return {};
  }

  // A look at some moments, before the proof.
  bool may_hold(const SlowedPath& path, const TimeLaw& law) const {
    const Limits& limits = nominal_.limits();
    for (int i = 1; i < kSamples; ++i) {
      const Vec3 a = path.at(law.at(law.duration_s() * i / kSamples)).acceleration;
      const double size = limits.norm == LimitNorm::euclidean ? a.norm() : a.cwiseAbs().maxCoeff();
      if (limits.norm != LimitNorm::horizontal_vertical && size > 1.001 * limits.a_max_m_s2) {
        return false;
      }
    }
    return true;
  }

  const CertifiedTrajectory& nominal_;
  const FreeSpace& space_;
  double until_s_;
  std::vector<Way> ways_;
};

}  // namespace

Result<std::optional<StopPart>> latest_stop(const CertifiedTrajectory& nominal,
                                            const FreeSpace& space, double from_s) {
  const auto found = find_obstruction(space, nominal.trajectory(), from_s);
  if (!found && nominal.ends_at_rest()) return std::optional<StopPart>();
  const double free_until_s = found ? found->time_s : nominal.duration_s();
  auto stop = LatestStop(nominal, space, free_until_s).find(from_s);
  if (stop) return std::optional(*std::move(stop));
  const std::string what = found ? to_text(*space.grid(), *found) : "it does not end at rest";
  return fail(ErrorCode::trajectory_blocked,
              fmt::format("no stop fits on it before it leaves known free space {:.3g} s after its "
                          "start: {}",
                          free_until_s, what));
}

}  // namespace goshawk
