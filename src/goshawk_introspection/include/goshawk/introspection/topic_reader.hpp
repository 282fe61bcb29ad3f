#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "goshawk/introspection/session.hpp"

namespace goshawk::introspection {

struct ReadOptions {
  std::string topic;
  int count = 0;           // messages until the end; 0: until Ctrl-C
  double timeout_s = 2.0;  // longest wait for the topic, and for the first message
  bool patient = false;    // waits for the first message without limit
  /// Of a latched topic, whose writers send their last messages, oldest first: only the newest of
  /// those, then the end.
  bool newest = false;
};

struct RawMessage {
  const std::vector<unsigned char>& bytes;
  std::int64_t received_ns;
};

/// Callbacks of read_topic().
struct TopicListener {
  /// Gets the type's ROS name before the first message. @return a failure to end
  std::function<Status(const std::string& type)> begin = [](const auto&) { return success(); };
  /// @return false to end
  std::function<bool(const RawMessage&)> message;
  /// About once a second while messages may come.
  std::function<void()> tick = [] {};
  /// A sentence about anything unusual.
  std::function<void(const std::string&)> note = [](const auto&) {};
};

/// Finds the topic, subscribes with the quality of service that its writers offer, and hands over
/// each message. @return invalid_parameter for an invalid name, stage_silent if no message, or
/// fewer than requested, came in time
Status read_topic(Session& session, const ReadOptions& options, const TopicListener& listener);

}  // namespace goshawk::introspection
