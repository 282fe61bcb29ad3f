#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "goshawk/why/snapshot.hpp"

namespace goshawk::why {

/// The one thing that keeps the vehicle from moving, or from moving faster.
enum class Binds {
  nothing,        // it has arrived, or is on its way and gains speed
  no_navigator,   // no sign of life
  no_odometry,    // the vehicle's position is unknown
  disarmed,       // the motors may not turn
  other_control,  // a person or the autopilot flies
  operator_hold,  // an operator holds it
  mission_waits,  // a mission is paused or has failed
  no_goal,        // nothing was asked for
  no_map,         // nothing can be checked
  silent_stage,   // a stage does not answer
  goal_blocked,   // the goal is in an obstacle, or too near to one
  goal_unknown,   // the goal is in space that was never seen
  goal_outside,   // the map does not reach there
  start_blocked,  // the vehicle's own place is in or too near to an obstacle, or was never seen
  unreachable,    // no path leads to the goal
  refused,        // a stage refused it for another reason
  tracker_stops,  // the tracker brakes or lands by itself
  unseen_ahead,   // what is flown ends before space that was never seen
  speed_limit,    // what is flown is at this limit now
  acceleration_limit,
  jerk_limit,
  end_ahead,  // it slows down towards the end of its trajectory
  way,        // below all limits: its trajectory turns
};
/// "goal_blocked"
std::string_view to_string(Binds binds);

/// A voxel that is in the way.
struct BlockingVoxel {
  Index3 index;
  Vec3 center_map = Vec3::Zero();
  bool known = true;        // false: it was never seen
  double distance_m = 0.0;  // from the place that it blocks to the voxel's nearest point
};

struct Reason {
  Binds binds = Binds::nothing;
  std::string doing = {};    // what the vehicle does, a sentence
  std::string because = {};  // what binds, a sentence
  std::string mend = {};     // what would change it, a sentence; may be empty
  std::optional<BlockingVoxel> voxel = {};
  std::optional<StageRole> stage = {};  // that is silent, refuses, or stops the vehicle
  std::string parameter = {};           // "navigator v_max_m_s", that would change it
};

/// What the vehicle does, and the one thing that binds. Looks first at what the later causes depend
/// on: a goal is judged only if vehicle, navigator, tracker and map are heard.
Reason explain(const Snapshot& snapshot);

/// Silent for longer than this, a stage or the vehicle counts as lost.
inline constexpr double kSilent_s = 1.5;
/// A limit binds from this share of it on.
inline constexpr double kAtLimit = 0.93;

}  // namespace goshawk::why
