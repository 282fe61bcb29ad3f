// Why a vehicle that flies does not fly faster.

#include <fmt/format.h>

#include <algorithm>

#include "causes.hpp"
#include "goshawk/core/free_curve.hpp"
#include "voxels.hpp"

namespace goshawk::why {
namespace {

/// What is flown, at one moment.
struct Moment {
  const CommittedTrajectory& committed;
  double t_s;
  FlatState state;

  const Limits& limits() const { return committed.nominal().limits(); }
  double left_s() const { return committed.flown().duration_s() - t_s; }
};

// From now on it gets slower until it rests.
bool only_slows(const Moment& m) {
  constexpr int kSteps = 32;
  double before_m_s = m.state.velocity.norm();
  for (int k = 1; k <= kSteps; ++k) {
    const double t_s = m.t_s + m.left_s() * k / kSteps;
    const double speed_m_s =
        m.committed.flown().sample(std::min(t_s, m.committed.flown().duration_s())).velocity.norm();
    if (speed_m_s > before_m_s + 1e-3) return false;
    before_m_s = speed_m_s;
  }
  return true;
}

// Its stop part is flown, because what lies behind was not seen.
std::optional<Reason> unseen(const Snapshot& s, const Moment& m) {
  const auto& stop = m.committed.stop();
  if (!stop || m.t_s < stop->after_s) return {};
  Reason reason{.binds = Binds::unseen_ahead,
                .because = "It stops: what lies ahead was not seen to be free",
                .mend =
                    "It flies on once the sensor sees more. With navigator fly_unknown and tracker "
                    "fly_unknown it flies through space that was not seen.",
                .parameter = "navigator fly_unknown"};
  const FreeSpace space(s.map);
  const Trajectory& nominal = m.committed.nominal().trajectory();
  if (const auto found = find_obstruction(space, nominal, stop->after_s)) {
    const Vec3 place = nominal.sample(std::min(found->time_s, nominal.duration_s())).position;
    reason.voxel = voxel_at(*s.map, found->voxel, place);
    reason.because += fmt::format(", near {} in map {}, {:.1f} s old", to_text(*reason.voxel),
                                  s.map->version, s.map_age_s);
  }
  reason.because += ".";
  return reason;
}

Reason limit(Binds binds, const std::string& what, const std::string& parameter) {
  return {.binds = binds,
          .because = fmt::format("It flies at its limit of {}.", what),
          .mend = fmt::format("A higher {} lets it fly faster.", parameter),
          .parameter = parameter};
}

std::optional<Reason> active_limit(const Moment& m) {
  const Limits& limits = m.limits();
  if (limits.speed_usage(m.state.velocity) >= kAtLimit) {
    return limit(Binds::speed_limit, fmt::format("{:g} m/s", limits.v_max_m_s),
                 "navigator v_max_m_s");
  }
  if (limits.acceleration_usage(m.state.acceleration) >= kAtLimit) {
    return limit(Binds::acceleration_limit, fmt::format("{:g} m/s²", limits.a_max_m_s2),
                 "navigator a_max_m_s2");
  }
  if (limits.j_max_m_s3 > 0.0 && m.state.jerk.norm() >= kAtLimit * limits.j_max_m_s3) {
    return limit(Binds::jerk_limit, fmt::format("{:g} m/s³", limits.j_max_m_s3),
                 "navigator j_max_in_flight_m_s3");
  }
  return {};
}

}  // namespace

Reason flight(const Snapshot& s) {
  if (!s.flown) {
    return {.binds = Binds::nothing, .because = "It waits for its first trajectory."};
  }
  const Trajectory& flown = s.flown->committed.flown();
  if (s.flown->time_s < 0.0) {
    return {.binds = Binds::nothing,
            .because = fmt::format("It begins to fly in {:.2f} s.", -s.flown->time_s)};
  }
  const double t_s = std::min(s.flown->time_s, flown.duration_s());
  const Moment now{s.flown->committed, t_s, flown.sample(t_s)};
  if (auto reason = unseen(s, now)) return *std::move(reason);
  if (auto reason = active_limit(now); reason && reason->binds == Binds::speed_limit) {
    return *std::move(reason);
  }
  if (only_slows(now)) {
    const Vec3 end = flown.sample(flown.duration_s()).position;
    return {.binds = Binds::end_ahead,
            .because = fmt::format("It slows down for the end of its trajectory, {:.2f} m ahead.",
                                   (end - now.state.position).norm()),
            .mend = "A higher navigator a_max_m_s2 lets it brake later.",
            .parameter = "navigator a_max_m_s2"};
  }
  if (auto reason = active_limit(now)) return *std::move(reason);
  if (now.state.velocity.dot(now.state.acceleration) > 0.0) {
    return {.binds = Binds::nothing, .because = "It gains speed."};
  }
  return {.binds = Binds::way,
          .because = "No limit is active: it slows down for a turn.",
          .mend = "With a higher navigator a_max_m_s2 it takes turns faster.",
          .parameter = "navigator a_max_m_s2"};
}

}  // namespace goshawk::why
