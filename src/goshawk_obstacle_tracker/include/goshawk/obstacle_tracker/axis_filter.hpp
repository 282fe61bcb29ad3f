#pragma once

namespace goshawk::obstacle_tracker {

/// A Kalman filter of position and velocity along one axis, whose acceleration is white noise,
/// constant over each step (Bar-Shalom, Li, Kirubarajan: Estimation with applications to tracking
/// and navigation, 2001, section 6.3.2).
struct AxisFilter {
  double position = 0.0, velocity = 0.0;  // [m], [m/s]
  double pp = 0.0, pv = 0.0, vv = 0.0;    // covariance

  static AxisFilter at(double position, double position_sd, double velocity_sd) {
    return {position, 0.0, position_sd * position_sd, 0.0, velocity_sd * velocity_sd};
  }

  /// @param dt_s 0 or more @param acceleration_sd [m/s^2]
  void predict(double dt_s, double acceleration_sd) {
    const double q = acceleration_sd * acceleration_sd, dt2 = dt_s * dt_s;
    position += velocity * dt_s;
    pp += 2.0 * dt_s * pv + dt2 * vv + 0.25 * q * dt2 * dt2;
    pv += dt_s * vv + 0.5 * q * dt2 * dt_s;
    vv += q * dt2;
  }

  /// @param sd [m] of the measured position, above 0
  void update(double measured, double sd) {
    const double s = pp + sd * sd, gain_p = pp / s, gain_v = pv / s, off = measured - position;
    position += gain_p * off;
    velocity += gain_v * off;
    vv -= gain_v * pv;
    pv -= gain_v * pp;
    pp -= gain_p * pp;
  }
};

}  // namespace goshawk::obstacle_tracker
