#include <fmt/format.h>

#include <cstdlib>

#include "goshawk/introspection/doctor.hpp"

namespace goshawk::introspection {
namespace {

constexpr const char* kAbout = "ROS 2";
constexpr const char* kFastLine = "export ROS_LOCALHOST_ONLY=1";
// Cyclone's own settings find nine processes of a domain: a flight alone has seven.
constexpr const char* kCycloneLine =
    "export CYCLONEDDS_URI='<CycloneDDS><Domain><General><Interfaces><NetworkInterface "
    "address=\"127.0.0.1\"/></Interfaces><AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>100"
    "</MaxAutoParticipantIndex><Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain>"
    "</CycloneDDS>'";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

// Whether what starts in that shell meets participants on loopback that send no multicast.
bool meets_loopback(const RosShell& shell) {
  if (!has(shell.middleware, "cyclone")) return shell.localhost_only == "1";
  const bool here = has(shell.cyclone_uri, "127.0.0.1") || has(shell.cyclone_uri, "\"lo\"") ||
                    has(shell.cyclone_uri, "'lo'");
  return here && has(shell.cyclone_uri, "MaxAutoParticipantIndex");
}

}  // namespace

RosShell ros_shell() {
  return {variable("RMW_IMPLEMENTATION"), variable("ROS_LOCALHOST_ONLY"),
          variable("CYCLONEDDS_URI"), !variable("FASTRTPS_DEFAULT_PROFILES_FILE").empty()};
}

Finding check_ros(const RosShell& shell, const std::string& interfaces, int ros_processes) {
  if (ros_processes > 0) {
    return {kAbout, Level::fine,
            fmt::format("{} process{} of ROS 2 in this domain", ros_processes,
                        ros_processes == 1 ? "" : "es")};
  }
  if (shell.has_profile) {
    return {kAbout, Level::note,
            "no process in this domain; the profile file decides whether one can be met",
            "rmw_fastrtps reads that file too, and Goshawk's choice of loopback does not apply",
            "give both sides the same file, or unset FASTRTPS_DEFAULT_PROFILES_FILE "
            "(docs/ros2.md)"};
  }
  const bool cyclone = has(shell.middleware, "cyclone");
  if (cyclone && !shell.cyclone_uri.empty() && !has(shell.cyclone_uri, "<")) {
    return {kAbout, Level::note,
            "no process in this domain; the file in CYCLONEDDS_URI decides whether one can be met",
            "Goshawk is found on its own interfaces alone, and it sends no multicast on loopback",
            "compare the file with the settings for Cyclone DDS in docs/ros2.md"};
  }
  if (interfaces != "loopback") {
    return {kAbout, Level::fine,
            fmt::format("no process in this domain; Goshawk is on the interfaces {}", interfaces)};
  }
  if (meets_loopback(shell)) {
    return {kAbout, Level::fine,
            "no process in this domain; one that starts in this shell meets Goshawk"};
  }
  return {kAbout, Level::note,
          "no process in this domain; one with the settings of this shell does not meet Goshawk, "
          "which is on loopback without multicast",
          "nodes and tools of ROS 2 then see no topic of Goshawk, without an error",
          fmt::format("in each shell of ROS 2: {}{}", cyclone ? kCycloneLine : kFastLine,
                      cyclone ? "" : " (for Cyclone DDS: docs/ros2.md)")};
}

}  // namespace goshawk::introspection
