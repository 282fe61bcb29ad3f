#pragma once

#include "goshawk/core/certified_trajectory.hpp"

namespace goshawk {

/// How fast a path's own time passes, and how far it has come, over real time since the start of
/// braking. The rate goes from one to zero as the integral of a trapezoid, so that the acceleration
/// has no jump.
class TimeLaw {
 public:
  /// @param fall_s how long the rate would take to fall at its fastest, >= ramp_s
  /// @param ramp_s of the deceleration, to its full value and back
  TimeLaw(double fall_s, double ramp_s)
      : ramp_s_(ramp_s), plateau_s_(fall_s - ramp_s), slope_(1.0 / fall_s) {}

  double ramp_s() const { return ramp_s_; }
  double duration_s() const { return plateau_s_ + 2.0 * ramp_s_; }
  /// [s] of the path's time that pass until rest.
  double passes_s() const { return duration_s() / 2.0; }

  struct At {
    double passed_s;  // of the path's time
    double rate;
    double rate_1_s;  // its derivative
  };
  /// @param u [s] since the start of braking, in [0, duration_s()]
  At at(double u) const;
  /// When so much of the path's time has passed. @param passed_s in [0, passes_s()]
  double when(double passed_s) const;

 private:
  double ramp_s_;
  double plateau_s_;
  double slope_;  // [1/s] of the rate, at its steepest
};

/// A trajectory that is braked along from a moment on: the same curve, ever slower.
class SlowedPath {
 public:
  /// @param path kept by reference @param from_s [s] in [0, path.duration_s())
  SlowedPath(const Trajectory& path, double from_s) : path_(path), from_s_(from_s) {}

  double left_s() const { return path_.duration_s() - from_s_; }
  FlatState at(const TimeLaw::At& law) const;
  FlatState start() const { return at({0.0, 1.0, 0.0}); }
  /// Quintics between its states: they leave the path by some 0.1 um. Each is in the polytope that
  /// the path is in there. @pre law.passes_s() < left_s()
  /// @param cut_at_ramps pieces end where the deceleration has risen and where it begins to fall.
  ///   On a straight line at constant speed they are then exact, and none exceeds its limit
  Trajectory by(const TimeLaw& law, bool cut_at_ramps = false) const;

 private:
  struct Knot {
    double time_s;
    int polytope;
  };
  std::vector<Knot> knots(const TimeLaw& law, bool cut_at_ramps) const;

  const Trajectory& path_;
  double from_s_;
};

/// Certifies a slowed trajectory, with those polytopes alone that it is in.
/// @param polytopes of the path @param from_s where it left the path, for their intervals
Result<CertifiedTrajectory> certify_slowed(const SlowedPath& path, const TimeLaw& law,
                                           Trajectory slowed, std::vector<Polytope> polytopes,
                                           double from_s, const Limits& limits);

}  // namespace goshawk
