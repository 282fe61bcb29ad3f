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
  no_odometry,    // nobody says where the vehicle is
  disarmed,       // the motors may not turn
  other_control,  // a person or the autopilot flies
  operator_hold,  // somebody holds it
  mission_waits,  // a mission is paused or has failed
  no_goal,        // nothing was asked for
  no_map,         // nothing can be checked
  silent_stage,   // a stage does not answer
  goal_blocked,   // the goal is in an obstacle, or too near to one
  goal_unknown,   // the goal is in space that was never seen
  goal_outside,   // the map does not reach there
  start_blocked,  // the vehicle's own place is
  unreachable,    // no way leads to the goal
  refused,        // a stage says why not, for another reason
  tracker_stops,  // the tracker brakes, holds or lands by itself
  unseen_ahead,   // what is flown ends before space that was never seen
  speed_limit,    // what is flown is at this limit now
  acceleration_limit,
  jerk_limit,
  end_ahead,  // it slows down towards the end of what is flown
  way,        // below all limits: the way, with its turns and obstacles
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
  std::optional<StageRole> stage = {};  // that is silent, or refuses
  std::string parameter = {};           // "navigator v_max_m_s", that would change it
};

/// What the vehicle does, and the one thing that binds. Looks at causes in the order in which one
/// hides the next: whoever does not hear the vehicle cannot blame the goal.
Reason explain(const Snapshot& snapshot);

/// Silent for longer than this, a stage or the vehicle counts as lost.
inline constexpr double kSilent_s = 1.5;
/// A limit binds from this share of it on.
inline constexpr double kAtLimit = 0.93;

}  // namespace goshawk::why
