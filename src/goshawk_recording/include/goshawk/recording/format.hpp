#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace goshawk::recording {

/// What an MCAP file is made of (https://mcap.dev/spec): schemas, channels that refer to them,
/// messages that refer to channels. Times are [ns] since 1970-01-01 UTC.

using Bytes = std::vector<unsigned char>;
using View = std::span<const unsigned char>;

struct Schema {
  std::uint16_t id = 0;       // 0: a channel without a schema
  std::string name = {};      // "goshawk_msgs/msg/Path"
  std::string encoding = {};  // "ros2msg"; empty: the definition is not known
  std::string data = {};      // the definition

  bool operator==(const Schema&) const = default;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;
  std::string topic = {};             // "/uav1/path"
  std::string message_encoding = {};  // "cdr"
  std::map<std::string, std::string> metadata = {};

  bool operator==(const Channel&) const = default;
};

/// A message whose bytes are owned elsewhere.
struct MessageView {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time_ns = 0;
  std::uint64_t publish_time_ns = 0;
  View data;
};

}  // namespace goshawk::recording
