#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "session.hpp"

namespace goshawk::introspection {

/// What echo, hz, delay and bw have in common.
struct ReadOptions {
  std::string topic;
  int count = 0;         // messages until the end; 0: until Ctrl-C
  bool patient = false;  // waits for the first message as long as it takes
};

struct RawMessage {
  const std::vector<unsigned char>& bytes;
  std::int64_t received_ns;
};

/// Finds the topic, subscribes with what its writers offer, hands over each message.
/// @param begin gets the type's ROS name before the first message; its status, unless 0, ends all
/// @param message @return false to end
/// @param tick runs about once a second while messages may come
/// @return exit status
int read_topic(const CommonOptions& common, const ReadOptions& options,
               const std::function<int(const std::string& type)>& begin,
               const std::function<bool(const RawMessage&)>& message,
               const std::function<void()>& tick);

}  // namespace goshawk::introspection
