#pragma once

#include "goshawk/core/result.hpp"
#include "goshawk/core/trajectory.hpp"
#include "goshawk/core/words.hpp"

namespace goshawk {

/// What a velocity or acceleration limit bounds: its Euclidean length, each component apart, or its
/// horizontal length and its vertical component apart.
enum class LimitNorm { euclidean, per_axis, horizontal_vertical };
constexpr auto words_of(LimitNorm) {
  using enum LimitNorm;
  return std::to_array<Named<LimitNorm>>({{euclidean, "euclidean"},
                                          {per_axis, "per_axis"},
                                          {horizontal_vertical, "horizontal_vertical"}});
}

struct Limits {
  double v_max_m_s = 2.0;   // [m/s] > 0
  double a_max_m_s2 = 2.0;  // [m/s^2] > 0
  LimitNorm norm = LimitNorm::euclidean;
  double j_max_m_s3 = 0.0;           // [m/s^3] of the jerk's Euclidean length; 0: no limit
  double v_max_vertical_m_s = 0.0;   // [m/s] horizontal_vertical only; 0: v_max_m_s
  double a_max_vertical_m_s2 = 0.0;  // [m/s^2] horizontal_vertical only; 0: a_max_m_s2

  /// @return invalid_limits, naming every limit that is not finite and above zero (j_max_m_s3 and
  /// the vertical ones: not finite or negative)
  Status check() const;

  /// How much of a limit is used: 1 at the limit. NaN if the vector or the limit is.
  double speed_usage(const Vec3& velocity) const;
  double acceleration_usage(const Vec3& acceleration) const;
};

/// Of a limit: a use above 1 by less than this is rounding, not an excess.
inline constexpr double kLimitRounding = 1e-6;

/// What a start above a limit is allowed until it is back under it; nothing if the start is within
/// the limits. Pieces that begin before `until_s` are held against these factors of the limits,
/// all others against the limits.
struct StartAllowance {
  double speed = 1.0;         // of the speed limit
  double acceleration = 1.0;  // of the acceleration limit
  double until_s = 0.0;       // [s] from the start of the trajectory

  /// Speed: the start's, and a tenth of a second of its acceleration more (a vehicle that is
  /// speeding up cannot brake at once). Acceleration: the start's. Until: twice the time that
  /// braking takes, and half a second.
  static StartAllowance of(const FlatState& start, const Limits& limits);
};

}  // namespace goshawk
