#pragma once

#include <string>
#include <vector>

#include "goshawk/movers/motion.hpp"
#include "goshawk/movers/oriented_box.hpp"

namespace goshawk::movers {

/// A box that moves as a pure, deterministic function of time.
struct Mover {
  std::uint64_t id = 0;        // unique among the movers of a world, from 1
  std::string kind{};          // "person", "vehicle", ...; may be empty
  Vec3 half_m = Vec3::Ones();  // half of each edge
  double start_s = 0.0;        // when its motion's time is 0
  Motion motion{};

  /// @param t_s [s] time of the world, finite
  BoxState at(double t_s) const;
  /// The same as a box.
  OrientedBox box_at(double t_s) const;
  /// [m/s] of its centre, at most
  double top_speed_m_s() const;
  /// [m/s] no point of the box is ever faster
  double top_point_speed_m_s() const;
  /// [m] from its centre to a corner
  double reach_m() const { return half_m.norm(); }
};

/// Where a ball first comes within a tolerance of a mover.
struct BallContact {
  double t_s = 0.0;
  Vec3 place_map = Vec3::Zero();  // [m] the nearest point of the box
};

/// A ball that moves evenly on a straight line.
struct MovingBall {
  Vec3 from_map = Vec3::Zero(), to_map = Vec3::Zero();  // [m] of its centre at both ends
  double from_s = 0.0, to_s = 0.0;                      // from_s <= to_s
  double radius_m = 0.0;                                // 0 or more
};

/// The first contact over an interval, continuous in time: conservative advancement (Mirtich 1996).
/// In each step nothing can come nearer than the distance minus the step times the largest
/// approaching speed, so no contact is passed over.
/// @param tolerance_m above 0: nearer than this is a contact
/// @return nothing if the ball keeps farther away than the tolerance all the time
/// @throws std::invalid_argument for a ball or a tolerance out of range
std::optional<BallContact> first_contact(const MovingBall& ball, const Mover& mover,
                                         double tolerance_m);

}  // namespace goshawk::movers
