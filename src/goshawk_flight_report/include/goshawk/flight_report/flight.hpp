#pragma once

#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/flight_report/map_timeline.hpp"
#include "goshawk/flight_report/movers.hpp"

namespace goshawk::flight_report {

/// Where the vehicle was at one moment, as flown. Frame `map`.
struct FlownSample {
  double t_s = 0.0;                                // [s] on the flight's clock
  Vec3 position_map = Vec3::Zero();                // [m]
  Vec3 velocity_map = Vec3::Zero();                // [m/s]
  Quaternion q_map_base = Quaternion::Identity();  // base_link to map
};

/// From one goal to the next. Missing parts stay empty and are not drawn: a leg may have a path and
/// no trajectory.
struct Leg {
  std::vector<Vec3> raw_path_map;   // [m] voxel centres as searched
  std::vector<Vec3> waypoints_map;  // [m] the pruned polyline
  std::vector<Polytope> corridor;
  Trajectory trajectory;
  double start_t_s = 0.0;  // [s] when the trajectory began, on the flight's clock
  double yaw_rad = 0.0;    // heading all the way if there is no curve
  std::optional<YawCurve> yaw_curve = {};
  double stop_after_s =
      0.0;  // [s] after its start: the trajectory's stop part begins; 0: it has none
  Trajectory nominal = {};  // to the goal: what the stop part leaves; empty without one

  /// What is flown of it, without the path.
  /// @param origin_ns when the flight's clock is 0
  static Leg of(const CommittedTrajectory& committed, std::int64_t origin_ns);

  /// Heading [rad], unwrapped. @param t_s since the trajectory began
  double yaw_at(double t_s) const { return yaw_curve ? yaw_curve->yaw_rad(t_s) : yaw_rad; }
};

/// What was followed of a leg's trajectory.
struct FollowedLeg {
  const Leg* leg = nullptr;
  Trajectory trajectory;    // up to where a newer leg replaced it
  double duration_s = 0.0;  // [s]
  bool whole = true;        // no newer leg replaced it
};

/// All that the pictures and files of one flight are made from.
struct Flight {
  std::string title = "Goshawk flight";
  const VoxelGrid* obstacles = nullptr;  // not owned: the map as it is, or nothing
  const VoxelGrid* grown = nullptr;      // not owned: grown by the vehicle, or nothing
  std::vector<Leg> legs;                 // in the order in which they were committed
  std::vector<FlownSample> flown;
  std::vector<Vec3> goals_map = {};       // [m] as they were sent; empty: the ends of the legs
  std::vector<MapMoment> maps = {};       // how the map grew, oldest first; on the flight's clock
  std::vector<MoversMoment> movers = {};  // what moved, oldest first
  std::vector<PredictionsMoment> predictions = {};  // where it was thought to go, oldest first
  Limits limits;
  double body_radius_m = 0.15;  // [m] obstacles this close in height to the flight are drawn dark

  /// @return invalid_input, naming the part: nothing to draw; numbers that are not finite or
  /// beyond 1e6 m; time of the flown track that goes backwards; a body without a radius; a grid, a
  /// polytope, a trajectory or limits that fail their own check
  Status check() const;

  /// The start and the goals [m], frame `map`. A vehicle that plans anew in flight has more legs
  /// than goals. Empty if neither a leg nor the track has a place.
  std::vector<Vec3> stops_map() const;

  /// The legs that were followed, in their order; those replaced at once are left out. Points into
  /// legs.
  std::vector<FollowedLeg> followed() const;

  /// The legs that no newer one replaced, and those without a trajectory. A vehicle that plans anew
  /// in flight replaces most of its legs.
  std::vector<const Leg*> kept_legs() const;

  /// Where the vehicle should be at t_s: on the newest leg that had begun, at that leg's end once
  /// its time is over. Nothing before the first leg, or if no leg has a trajectory.
  std::optional<FlatState> planned_at(double t_s) const;
};

}  // namespace goshawk::flight_report
