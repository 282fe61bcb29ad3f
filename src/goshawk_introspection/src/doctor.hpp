#pragma once

#include <string>
#include <vector>

#include "goshawk/runtime/context.hpp"

namespace goshawk::introspection {

enum class Level {
  fine,     // nothing to do
  note,     // worth knowing
  warning,  // works, but not well
  fault,    // does not work
};

/// One thing that was looked at.
struct Finding {
  std::string about;  // "loopback", "topic /path"
  Level level = Level::fine;
  std::string message;  // a sentence: what is, and how to mend it
};

std::string to_string(Level level);

/// The machine and its settings: cores, loopback, socket buffers, shared memory, clock, priorities.
std::vector<Finding> check_machine();

/// The environment: domain, interfaces, profile file.
std::vector<Finding> check_environment();

/// Whether those who write and read a topic can hear each other, and whether names are unique.
/// Pure: of what was discovered.
std::vector<Finding> check_topics(const std::vector<runtime::ParticipantInfo>& participants,
                                  const std::vector<runtime::EndpointInfo>& endpoints);

/// Domains with processes on this machine, by the UDP ports that are in use.
/// @param udp_table the content of /proc/net/udp
std::vector<int> domains_in_use(const std::string& udp_table);

}  // namespace goshawk::introspection
