#pragma once

#include <vector>

#include "goshawk/core/certificate.hpp"

namespace goshawk {

/// A trajectory that is proved to stay in its polytopes and within its limits. Only certify() makes
/// one, so that holding one is the proof.
class CertifiedTrajectory {
 public:
  const Trajectory& trajectory() const { return trajectory_; }
  const std::vector<Polytope>& polytopes() const { return polytopes_; }
  const Limits& limits() const { return limits_; }
  const FlatState& start() const { return start_; }  // that it was asked to begin with
  const FlatState& goal() const { return goal_; }    // and to end with
  const Certificate& certificate() const { return certificate_; }

  double duration_s() const { return trajectory_.duration_s(); }
  /// Slower than 1 mm/s and 1 mm/s^2 at the end: safe if nothing follows.
  bool ends_at_rest() const;

 private:
  CertifiedTrajectory() = default;
  friend Result<CertifiedTrajectory> certify(Trajectory, std::vector<Polytope>, const Limits&,
                                             const FlatState&, const FlatState&);

  Trajectory trajectory_;
  std::vector<Polytope> polytopes_;
  Limits limits_;
  FlatState start_;
  FlatState goal_;
  Certificate certificate_;
};

/// @param polytopes each piece names the one that it stays in
/// @param start, goal the states that the trajectory was asked to begin and end with
/// @return invalid_input (no piece, not finite, an invalid polytope, a piece without its polytope),
///   invalid_limits, or not_certified with the family that is violated most
Result<CertifiedTrajectory> certify(Trajectory trajectory, std::vector<Polytope> polytopes,
                                    const Limits& limits, const FlatState& start,
                                    const FlatState& goal);

}  // namespace goshawk
