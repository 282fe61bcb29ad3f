#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk::runtime {

/// How ROS 2 is told of the nodes: in the bytes of one of its versions, which differ.
enum class RosGraphLayout {
  automatic,  // Humble's, until a process of Iron or later is met
  humble,
  iron,  // and later
  off,   // ROS 2 sees the topics, but not the nodes
};

struct ContextOptions {
  int domain = 0;                       // 0 to 232
  std::string interfaces = "loopback";  // "loopback", "all", or IPv4 addresses with commas
  std::vector<std::string> node_names;  // full names, for `goshawk node list`
  RosGraphLayout ros_graph = RosGraphLayout::automatic;
  /// For tests: is given each datagram that arrives, before it is checked, and each one sent. It is
  /// called by Fast DDS' threads, several at once.
  std::function<void(std::span<const std::byte> datagram, bool sent)> tap{};

  /// ROS_DOMAIN_ID, GOSHAWK_INTERFACES and GOSHAWK_ROS_GRAPH, if they are set.
  /// @return invalid_parameter for a domain that is not a number from 0 to 232, for empty
  /// interfaces, or for a layout that is not auto, humble, iron or off
  static Result<ContextOptions> from_environment();
};

/// What is in the domain at one moment.
struct EndpointInfo {
  std::string topic;  // as ROS names it: "/uav1/path"; what is no topic of ROS, as on the wire
  std::string type;   // "goshawk_msgs/msg/Path"
  std::string participant;  // guid prefix
  bool writer = false;
  bool reliable = false;
  bool transient_local = false;
};
struct ParticipantInfo {
  std::string guid_prefix;
  std::string name;
  std::vector<std::string> nodes;
  std::string version = "";  // of Goshawk; empty: another program, or one that does not say
  bool is_ros = false;       // a process of ROS 2
};

/// One DDS participant: a process' membership in a domain.
///
/// An XML profile file (FASTRTPS_DEFAULT_PROFILES_FILE) with a default participant profile
/// decides about transports; without one they are UDP on the chosen interfaces, by default on
/// loopback only, found without multicast. Either way, every datagram is checked before Fast DDS
/// reads it.
class Context {
 public:
  struct Impl;

  /// @return invalid_parameter for a domain or an interface that does not exist, io_failed if the
  /// domain cannot be joined
  static Result<std::unique_ptr<Context>> create(const ContextOptions& options);
  ~Context();

  int domain() const;
  std::vector<ParticipantInfo> participants() const;  // others, not this one
  std::vector<EndpointInfo> endpoints() const;        // of others

  /// From here on participants() names the nodes of ROS 2's processes too, but those that ROS 2
  /// hides. Does nothing with the permissions of DDS Security, which hold no topic for it.
  /// @return io_failed if the middleware gives no reader
  Status watch_ros_nodes();

  /// Malformed or forged datagrams, which Fast DDS was not given (docs/security.md).
  std::uint64_t refused_datagrams() const;
  std::string last_refusal() const;  // what was wrong and who sent it; empty: none yet

  Impl& impl() { return *impl_; }

 private:
  explicit Context(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// "goshawk_msgs::msg::dds_::Path_" to "goshawk_msgs/msg/Path", and back.
std::string ros_type_name(std::string_view wire_name);
std::string wire_type_name(std::string_view ros_name);

}  // namespace goshawk::runtime
