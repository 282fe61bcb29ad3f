#include "record.hpp"

#include <algorithm>

#include "goshawk/closed_loop/obstacle_distance.hpp"

namespace goshawk::league {
namespace {

constexpr double kExcess = 1e-3;  // as the published analyses count it
constexpr flight_check::Body kBody{.radius_m = closed_loop::kBody_m, .height_m = 0.1};

}  // namespace

double use_of(const FlatState& reference, const Limits& limits) {
  double use = std::max(limits.speed_usage(reference.velocity),
                        limits.acceleration_usage(reference.acceleration));
  if (limits.j_max_m_s3 > 0.0) use = std::max(use, reference.jerk.norm() / limits.j_max_m_s3);
  return use;
}

void record(const Moment& moment, const Limits& limits, Outcome& outcome) {
  const double use = use_of(moment.reference, limits);
  outcome.worst_use = std::max(outcome.worst_use, use);
  if (use > 1.0 + kExcess) ++outcome.violations;
  outcome.top_speed_m_s = std::max(outcome.top_speed_m_s, moment.vehicle.velocity_map.norm());
  if (!outcome.track.empty()) {
    const Moment& before = outcome.track.back();
    outcome.length_m += (moment.vehicle.position_map - before.vehicle.position_map).norm();
    outcome.jerk_m_s2 += moment.reference.jerk.norm() * (moment.t_s - before.t_s);
  }
  outcome.track.push_back(moment);
}

Status judge(const Scene& scene, Outcome& outcome) {
  const auto check = flight_check::FlightCheck::from_solids(scene.solids, kBody);
  if (!check) return check.error();
  std::vector<flight_check::Sample> track;
  track.reserve(outcome.track.size());
  for (const Moment& m : outcome.track) {
    track.push_back({m.t_s, m.vehicle.position_map, m.vehicle.q_map_base});
  }
  auto verdict = check->judge(track);
  if (!verdict) return verdict.error();
  outcome.verdict = *std::move(verdict);
  return success();
}

}  // namespace goshawk::league
