#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "ros_entities.hpp"

namespace goshawk::runtime {

inline constexpr const char* kRosDiscoveryTopic = "ros_discovery_info";  // no prefix
inline constexpr const char* kRosDiscoveryType =
    "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

Gid gid_of(const eprosima::fastrtps::rtps::GUID_t& guid);

/// Tells ROS 2 which nodes a participant has, and what they read and write: the whole state, again
/// after each change. Safe to call from several threads, those of Fast DDS too. Until open() and
/// after close() it only keeps count.
class RosGraph {
 public:
  using Guid = eprosima::fastrtps::rtps::GUID_t;

  /// @param writer of kRosDiscoveryTopic @param named full names of the nodes that lists show; the
  /// others get a leading '_', by which ROS 2 hides a node
  void open(eprosima::fastdds::dds::DomainParticipant& participant,
            eprosima::fastdds::dds::DataWriter* writer, RosGraphLayout layout,
            const std::vector<std::string>& named);
  void close();

  /// A node of that full name begins or ends. Several may share it (Node::beside()).
  void enter(const std::string& node);
  void leave(const std::string& node);
  void add_reader(const std::string& node, const Guid& reader);
  void add_writer(const std::string& node, const Guid& writer);
  void remove(const Guid& endpoint);

  /// A peer of Iron or later is here: gids have its length from now on, unless the layout was
  /// chosen.
  void found_iron();

 private:
  struct NodeEntry {
    int count = 0;
    std::set<Gid> readers{};
    std::set<Gid> writers{};
  };

  std::string shown_name(const std::string& node) const;
  void publish();

  std::mutex mutex_;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  Gid participant_{};
  RosGraphLayout layout_ = RosGraphLayout::automatic;
  std::set<std::string> named_;
  std::map<std::string, NodeEntry> nodes_;  // by full name
  MessageType type_ = raw_message_type(kRosDiscoveryType);
};

}  // namespace goshawk::runtime
