#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::movers {

/// Where a box is at one moment, and how it moves. Frame `map`.
struct BoxState {
  Vec3 position_map = Vec3::Zero();               // [m] of its centre
  Quaternion q_map_box = Quaternion::Identity();  // box to map
  Vec3 velocity_map = Vec3::Zero();               // [m/s] of its centre
  Vec3 angular_velocity_map = Vec3::Zero();       // [rad/s]
};

/// A motion is a pure function of the time since it began: `at(t_s)` for any finite time, negative
/// ones included. `top_speed_m_s()` and `top_turn_rad_s()` bound the speed of the centre and the
/// angular speed at all times, so `position` and `orientation` are continuous in time.

/// A thing that could move, and does not.
struct Still {
  Vec3 position_map = Vec3::Zero();  // [m]
  double yaw_rad = 0.0;

  BoxState at(double t_s) const;
  double top_speed_m_s() const { return 0.0; }
  double top_turn_rad_s() const { return 0.0; }
};

/// What a walk does at the end of its points.
enum class Repeat { loop, back_and_forth, once };

struct WalkParameters {
  std::vector<Vec3> points_map{};  // [m] of the box's centre, two or more
  std::vector<double> pauses_s{};  // at each point; empty: none
  double speed_m_s = 1.0;          // above 0
  double acceleration_m_s2 = 0.0;  // 0: speed changes at once; else it comes to rest at points
  double turn_rate_rad_s = 3.0;    // turns on the spot at points; 0: keeps its heading
  Repeat repeat = Repeat::back_and_forth;
};

/// A walker or a vehicle on a polyline: straight from point to point, the box's x axis ahead.
class Walk {
 public:
  /// @return invalid_input that names the parameter at fault
  static Result<Walk> create(const WalkParameters& parameters);

  BoxState at(double t_s) const;
  double top_speed_m_s() const { return speed_m_s_; }
  double top_turn_rad_s() const { return turn_rate_rad_s_; }
  /// [s] once around; of a walk that is not repeated, its whole duration
  double period_s() const { return end_s_.back(); }

 private:
  /// A straight way, a turn or a pause.
  struct Phase {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // [m] map
    double yaw_rad = 0.0, turn_rad = 0.0;         // at its begin; by how much it turns
  };

  void add(const Phase& phase, double duration_s);
  void fill(const WalkParameters& parameters, const std::vector<Vec3>& points,
            const std::vector<double>& pauses_s, bool repeats);
  double duration_s(double length_m) const;

  double speed_m_s_ = 0.0, acceleration_m_s2_ = 0.0, turn_rate_rad_s_ = 0.0;
  bool repeats_ = true;
  std::vector<Phase> phases_;
  std::vector<double> end_s_;  // of each phase
};

/// Turns about a fixed axis through a pivot: on and on, or to and fro as a pendulum.
struct Turn {
  Vec3 pivot_map = Vec3::Zero();  // [m]
  Vec3 axis_map = Vec3::UnitZ();  // of length 1
  Vec3 arm_map = Vec3::Zero();    // [m] pivot to the box's centre at angle 0
  double amplitude_rad = 0.0;     // 0: on and on
  double rate_rad_s = 1.0;        // angular speed; with an amplitude: 2 pi / period

  BoxState at(double t_s) const;
  double top_speed_m_s() const;
  double top_turn_rad_s() const;
};

/// To and fro on a straight line: centre + reach sin(2 pi t / period).
struct Slide {
  Vec3 center_map = Vec3::Zero();  // [m]
  Vec3 reach_map = Vec3::UnitX();  // [m]
  double period_s = 4.0;           // above 0

  BoxState at(double t_s) const;
  double top_speed_m_s() const;
  double top_turn_rad_s() const { return 0.0; }
};

/// The trefoil of the dynamic worlds of SANDO (arXiv 2604.07599; scripts/run_sim.py and
/// launch/dyn_obstacles.launch.py of its repository): u = t / k + offset,
/// x = x0 + sx/6 (sin u + 2 sin 2u), y = y0 + sy/5 (cos u - 2 cos 2u), z = z0 - sz/2 sin 3u.
struct Trefoil {
  Vec3 center_map = Vec3::Zero();  // [m]
  Vec3 scale_m = Vec3::Ones();
  double offset_rad = 0.0;
  double divisor_s = 5.0;  // k, above 0

  BoxState at(double t_s) const;
  double top_speed_m_s() const;
  double top_turn_rad_s() const { return 0.0; }
  /// [m] once around, to 1e-6 of it
  double length_m() const;
};

/// A place of a recorded track.
struct Place {
  double t_s = 0.0;
  Vec3 position_map = Vec3::Zero();  // [m]
  double yaw_rad = 0.0;
};

/// A recorded track: straight and even between its places, along the shorter turn. Before the first
/// place and after the last it stands still, unless it repeats.
class Track {
 public:
  /// @param repeats from the last place on as from the first; both must be the same place
  /// @return invalid_input that names the place at fault: times that do not rise, a number that is
  /// not finite, or a jump (faster than 100 m/s or 30 rad/s)
  static Result<Track> create(std::vector<Place> places, bool repeats);

  BoxState at(double t_s) const;
  double top_speed_m_s() const { return top_speed_m_s_; }
  double top_turn_rad_s() const { return top_turn_rad_s_; }

 private:
  std::vector<Place> places_;
  bool repeats_ = false;
  double top_speed_m_s_ = 0.0, top_turn_rad_s_ = 0.0;
};

using Motion = std::variant<Still, Walk, Turn, Slide, Trefoil, Track>;

}  // namespace goshawk::movers
