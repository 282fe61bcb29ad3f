#pragma once

#include <functional>
#include <optional>
#include <string>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"
#include "goshawk/introspection/session.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"

namespace goshawk::cli {

/// "/uav1" and "odom": "/uav1/odom".
std::string topic_in(const std::string& space, const std::string& name);

/// Why nobody takes goals or commands: the guard flies the vehicle, or no flight is found.
/// @param topic that was sent on, full name @param waited_s how long an answer was waited for
Error no_taker(const introspection::Session& session, const std::string& space,
               const std::string& topic, double waited_s);
/// Whether the guard flies the vehicle in the navigator's place.
bool has_guard(const introspection::Session& session, const std::string& space);

/// How a goal ended.
struct Arrival {
  Vec3 goal_map = Vec3::Zero();
  double distance_m = 0.0;  // of the vehicle from the goal, at the end
  double time_s = 0.0;      // since the goal was sent
};

/// Sends goals to a flight that runs, and waits for the vehicle.
class Pilot {
 public:
  using Say = std::function<void(const std::string&)>;

  /// @param space of the vehicle: "/uav1", or "/"
  Pilot(introspection::Session& session, const std::string& space, Say say);

  /// Waits for odometry and for a navigator. @return stage_silent, cancelled
  Status wait_ready(double timeout_s);

  /// @pre wait_ready() is ok
  Vec3 position_map() const { return *position_map_; }

  /// @pre wait_ready() is ok @param yaw_rad at the goal; none: as now
  /// @return why the navigator gave the goal up, deadline_exceeded, or cancelled by Ctrl-C (the
  /// vehicle then flies on)
  Result<Arrival> go(const Vec3& goal_map, std::optional<double> yaw_rad, double timeout_s);

  /// What the navigator has said until now answers nothing that follows.
  void forget_answers();
  /// Waits until the vehicle is at a goal that somebody has sent since forget_answers().
  /// @param goal_map none: the navigator's @return as go()
  Result<Arrival> arrive(std::optional<Vec3> goal_map, double timeout_s);
  /// Waits until the vehicle rests. @return deadline_exceeded, cancelled
  Status rest(double timeout_s);

 private:
  bool is_answered() const;
  void tell_progress(const Vec3& goal_map);

  introspection::Session& session_;
  Say say_;
  std::string space_;
  std::string goal_topic_;
  runtime::Publisher<geometry_msgs::msg::PoseStamped> goals_;
  std::optional<Vec3> position_map_;
  double speed_m_s_ = 0.0;
  int resting_ = 0;  // how often in a row odometry said so
  double yaw_rad_ = 0.0;
  std::optional<goshawk_msgs::msg::NavigatorState> state_;  // since the goal was sent
  std::int64_t newest_ns_ = 0;                              // [ns] stamp of the newest state
  std::int64_t asked_ns_ = 0;                               // [ns] newest_ns_ when it was sent
};

}  // namespace goshawk::cli
