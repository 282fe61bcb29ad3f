#pragma once

#include <functional>
#include <optional>
#include <string>

#include "goshawk/core/result.hpp"
#include "goshawk/introspection/session.hpp"
#include "goshawk_msgs.h"

namespace goshawk::cli {

/// "flying to waypoint 2 of 5, 12.3 m left: SENTENCE"
std::string progress_line(const goshawk_msgs::msg::MissionState& state);

/// Follows a mission that a stage flies.
class MissionWatch {
 public:
  using State = goshawk_msgs::msg::MissionState;
  /// @param line how far it is @param is_new another state or waypoint than the line before
  using Tell = std::function<void(const std::string& line, bool is_new)>;

  MissionWatch(introspection::Session& session, const std::string& space);

  /// The newest state. @return stage_silent if none comes within timeout_s; cancelled by Ctrl-C
  Result<State> newest(double timeout_s);

  /// Waits until the mission is done, has failed or is cancelled. A paused one is waited for.
  /// @param id of the mission; another one in its place ends the wait with cancelled
  /// @return its last state; deadline_exceeded; stage_silent: nothing came for kSilence_s;
  ///   cancelled by Ctrl-C
  Result<State> follow(std::uint64_t id, double timeout_s, const Tell& tell);

  static constexpr double kSilence_s = 30.0;  // a stage that is restarted is back sooner

 private:
  introspection::Session& session_;
  std::string topic_;
  std::optional<State> state_ = {};
  std::uint64_t heard_ = 0;  // states
};

}  // namespace goshawk::cli
