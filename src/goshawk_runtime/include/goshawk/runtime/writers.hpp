#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace goshawk::runtime {

/// A process as a member of the domain: the prefix of its GUID.
using Participant = std::array<std::byte, 12>;

/// Who may be heard on a topic (docs/adr/0013-one-writer.md).
///
///     node.subscribe<Odometry>("odom", Qos::best_effort(), callback, Writers::one("odom"));
struct Writers {
  /// Topics of one group are heard from one process: the first that writes one of them, for as long
  /// as it lives. Empty: everybody is heard.
  std::string group;

  /// Splits a group by what a message says of itself, such as the role of a stage: one process is
  /// heard for each value, everybody for 0. Empty: the group is not split.
  std::function<std::uint8_t(const void* message)> part;

  static Writers any() { return {}; }
  static Writers one(std::string group) { return {std::move(group), {}}; }
  template <typename Message>
  static Writers one_each(std::string group, std::function<std::uint8_t(const Message&)> part) {
    return {std::move(group), [part = std::move(part)](const void* message) {
              return part(*static_cast<const Message*>(message));
            }};
  }
};

}  // namespace goshawk::runtime
