#pragma once

#include <cstdint>
#include <string>

#include "goshawk/recording/format.hpp"
#include "goshawk/recording_tools/record.hpp"
#include "goshawk/runtime/node.hpp"

namespace goshawk::recording {

inline constexpr const char* kTurnType = "goshawk_msgs/msg/Turn";
inline constexpr const char* kTurnEnd = "/turn";
inline constexpr const char* kClock = "/clock";

/// The node whose turns a topic carries ("/tracker" of "/tracker/turn"), or "" for other topics.
std::string turn_of(const std::string& topic, const std::string& type);

/// Gives recorded turns as the plant gave them (docs/adr/0006-lock-step.md): the next
/// message is not published before the node has answered.
class TurnGiver {
 public:
  TurnGiver(runtime::Node& node, Say say);

  /// A turn for the node that led the recorded flight and had no turns itself: it serves the
  /// messages of a step of /clock at the end of that step.
  /// @param clock bytes of the Clock that begins the next step; nullptr: the last one has ended
  Status give_plant(const runtime::RawPublisher& turns, const Bytes* clock,
                    const std::string& plant);

  /// @param turn bytes of a Turn. @param follower full name of its node
  /// @return invalid_input if the bytes are not a turn; success also if Ctrl-C came first
  Status give(const runtime::RawPublisher& turns, Bytes& turn, const std::string& follower);

 private:
  runtime::Node& node_;
  Say say_;
  std::int64_t step_ns_ = 0;  // [ns] time of the step that is played, once there is one
  std::uint64_t plant_turn_ = 0;
  std::string who_;           // answered last, ...
  std::uint64_t number_ = 0;  // ... and which turn
};

}  // namespace goshawk::recording
