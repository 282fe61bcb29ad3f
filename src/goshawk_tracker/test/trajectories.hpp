#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/tracker/config.hpp"

namespace goshawk::tracker {

/// Flies what no map was asked about, until one comes.
inline Config without_map(Config config = {}) {
  config.require_map = false;
  return config;
}

/// What becomes a committed trajectory; tests change it first.
struct Draft {
  std::uint64_t id = 1;
  Trajectory trajectory;
  std::vector<Polytope> polytopes;
  Limits limits;
  FlatState start;
  FlatState goal;
  std::int64_t start_time_ns = 0;
  double yaw_rad = 0.0;
  std::optional<YawCurve> yaw_curve = {};

  operator CommittedTrajectory() const;  // NOLINT: implicit, so that it can be accepted as it is
  std::shared_ptr<const CommittedTrajectory> shared() const;
};

/// A C2 trajectory of quintics through random points, at rest at both ends, whose curve
/// (not only its hull) reaches v_max or a_max. @param start where it begins
Draft random_trajectory(Random& random, const Vec3& start, int pieces, double v_max_m_s,
                        double a_max_m_s2);

/// Start to end in one quintic from rest to rest, certified inside a large box.
Draft straight_line(const Vec3& start, const Vec3& end, double duration_s);

/// The limits that its own hull keeps, and the start and goal it has: so that it certifies.
void certify_as_is(Draft& draft);

}  // namespace goshawk::tracker
