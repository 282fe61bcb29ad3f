#pragma once

#include <cstdint>
#include <optional>

#include "goshawk/core/certified_trajectory.hpp"
#include "goshawk/core/yaw_curve.hpp"

namespace goshawk {

/// A way to rest that leaves the nominal trajectory.
struct StopPart {
  double after_s = 0.0;            // [s] after the nominal part's start: it begins here
  CertifiedTrajectory trajectory;  // begins in the nominal part's state then; times from its start
};

/// What goes into a CommittedTrajectory.
struct Commitment {
  std::uint64_t id = 0;               // of the request that it answers
  CertifiedTrajectory nominal;        // to the goal
  std::optional<StopPart> stop = {};  // flown unless a newer commit came before it begins
  std::int64_t start_time_ns = 0;     // when the nominal part begins; may be past
  std::uint64_t map_version = 0;      // both parts are proved against this grid
  double yaw_rad = 0.0;               // heading all the way if there is no curve; map, from x to y
  std::optional<YawCurve> yaw_curve = {};
};

/// A trajectory that the vehicle flies, whatever happens next: it ends at rest. Frame `map`.
class CommittedTrajectory {
 public:
  /// @return not_certified (no stop part and the nominal part does not end at rest, a stop part
  ///   that does not, or that begins elsewhere than in the nominal part's state), invalid_input (a
  ///   stop part that begins before the nominal part or after its end, yaw or time out of range)
  static Result<CommittedTrajectory> make(Commitment content);

  std::uint64_t id() const { return content_.id; }
  const CertifiedTrajectory& nominal() const { return content_.nominal; }
  const std::optional<StopPart>& stop() const { return content_.stop; }
  std::int64_t start_time_ns() const { return content_.start_time_ns; }
  std::uint64_t map_version() const { return content_.map_version; }
  double yaw_rad() const { return content_.yaw_rad; }
  const std::optional<YawCurve>& yaw_curve() const { return content_.yaw_curve; }

  /// What is flown when nothing newer comes: the nominal part up to where the stop part begins,
  /// then the stop part. A piece's polytope is one of flown_polytopes().
  const Trajectory& flown() const {
    return content_.stop ? to_rest_ : content_.nominal.trajectory();
  }
  /// The nominal part's, then the stop part's; their intervals count from the start of flown().
  std::vector<Polytope> flown_polytopes() const;

  /// Heading. @param t_s since the start, clamped to the curve; @return [rad], unwrapped
  double yaw_at(double t_s) const {
    return content_.yaw_curve ? content_.yaw_curve->yaw_rad(t_s) : content_.yaw_rad;
  }

 private:
  explicit CommittedTrajectory(Commitment content);

  Commitment content_;
  Trajectory to_rest_;  // only with a stop part
};

}  // namespace goshawk
