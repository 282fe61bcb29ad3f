#pragma once

#include <cstdint>
#include <string>

#include "goshawk/recording/format.hpp"
#include "goshawk/runtime/node.hpp"

namespace goshawk::recording {

inline constexpr const char* kTurnType = "goshawk_msgs/msg/Turn";

/// The node whose turns a topic carries ("/tracker" of "/tracker/turn"), or "" for other topics.
std::string turn_of(const std::string& topic, const std::string& type);

/// Gives recorded turns again, as the plant gave them (docs/adr/0006-lock-step.md): the next
/// message is not published before the node has answered.
class TurnGiver {
 public:
  explicit TurnGiver(runtime::Node& node);

  /// @param turn bytes of a Turn. @param follower full name of its node
  /// @return invalid_input where the bytes are no turn; success too where Ctrl-C came first
  Status give(const runtime::RawPublisher& turns, Bytes& turn, const std::string& follower);

 private:
  runtime::Node& node_;
  std::string who_;  // answered last, ...
  std::uint64_t number_ = 0;  // ... and which turn
};

}  // namespace goshawk::recording
