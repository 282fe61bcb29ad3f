#pragma once

#include <map>
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

/// One thing that was checked; unless it is fine, also why it matters and what mends it.
struct Finding {
  std::string about;  // "loopback", "topic /path"
  Level level = Level::fine;
  std::string message;    // the state
  std::string why = "";   // why it matters
  std::string mend = "";  // what to do
};

std::string to_string(Level level);

/// Checks the machine, the settings and the domain.
/// @param timeout_s longest wait for others in the domain
std::vector<Finding> examine(double timeout_s);

/// The machine and its settings: cores, loopback, socket buffers, shared memory, disk, priorities.
std::vector<Finding> check_machine();

/// The environment: domain, interfaces, profile file.
std::vector<Finding> check_environment();

/// What decides in a shell whether a program of ROS 2 that starts there meets Goshawk.
struct RosShell {
  std::string middleware;      // RMW_IMPLEMENTATION; empty: ROS 2's default, Fast DDS
  std::string localhost_only;  // ROS_LOCALHOST_ONLY
  std::string cyclone_uri;     // CYCLONEDDS_URI
  bool has_profile = false;    // FASTRTPS_DEFAULT_PROFILES_FILE
};
RosShell ros_shell();

/// Why ROS 2 sees nothing of Goshawk, and the line that mends it.
/// @param interfaces of Goshawk: "loopback", "all" or addresses @param ros_processes in the domain
Finding check_ros(const RosShell& shell, const std::string& interfaces, int ros_processes);

/// Versions of Goshawk and of its libraries, as compiled and as loaded, and the viewer's browser.
std::vector<Finding> check_versions();

/// @param compiled "2.9.1", empty: not known @param loaded the file that the loader took, such as
/// ".../libfastrtps.so.2.9.1", empty: not loaded here
Finding compare_versions(const std::string& name, const std::string& compiled,
                         const std::string& loaded);

/// Whether writers and readers of each topic match, names are unique, and versions the same. A pure
/// function of what was discovered.
std::vector<Finding> check_topics(const std::vector<runtime::ParticipantInfo>& participants,
                                  const std::vector<runtime::EndpointInfo>& endpoints);

/// Domains with processes on this machine, by the UDP ports that are in use.
/// @param udp_table the content of /proc/net/udp
std::vector<int> domains_in_use(const std::string& udp_table);

/// Sockets in use: port to inode, of /proc/net/udp, or of /proc/net/tcp if it listens.
std::map<int, long> ports_in_use(const std::string& table);

/// UDP ports of the domain that are held by a program that is not a participant: it has a user's
/// port without the discovery port that belongs to it.
std::vector<int> stolen_ports(const std::map<int, long>& udp_ports, int domain);

/// Obstacles to this domain's ports and the viewer's.
/// @param bridge_runs a viewer_bridge is in the domain: its port is rightly taken
std::vector<Finding> check_ports(int domain, bool bridge_runs);

/// @param first, last of the ports that the system hands out to programs that ask for any
Finding check_port_range(int domain, int first, int last);

/// The state of the machine's clock, and whether it was set between two readings.
class ClockWatch {
 public:
  ClockWatch();
  /// @return findings since construction
  std::vector<Finding> findings() const;

 private:
  double offset_s_;
};

/// Of datagrams that a node's process refused. @param count at least one @param message its
/// report's
Finding check_refused(const std::string& node, std::uint64_t count, const std::string& message);

/// @param jump_s [s] change of the clock while it was watched
Finding check_clock_jump(double jump_s);

/// @param ages_s [s] of a topic's messages when they came; at least one
Finding check_stamps(const std::string& topic, const std::vector<double>& ages_s);

}  // namespace goshawk::introspection
