#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <chrono>
#include <map>
#include <mutex>

#include "goshawk/runtime/context.hpp"
#include "one_writer.hpp"
#include "ros_graph.hpp"
#include "wire/receive_filter.hpp"

namespace goshawk::runtime {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// Keeps a list of the domain's participants and endpoints.
class DiscoveryListener : public dds::DomainParticipantListener {
 public:
  void on_participant_discovery(dds::DomainParticipant* participant,
                                rtps::ParticipantDiscoveryInfo&& info) override;
  void on_publisher_discovery(dds::DomainParticipant* participant,
                              rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(dds::DomainParticipant* participant,
                               rtps::ReaderDiscoveryInfo&& info) override;
  void onParticipantAuthentication(dds::DomainParticipant* participant,
                                   rtps::ParticipantAuthenticationInfo&& info) override;

  std::vector<ParticipantInfo> participants() const;
  std::vector<EndpointInfo> endpoints() const;
  /// @return how many participants and endpoints are known now
  std::size_t known() const;

  /// Nodes, process and GUID of a participant, for a sentence.
  std::string describe(const Participant& participant) const;
  /// @return whether it says that it runs nodes, as stages do
  bool has_nodes(const Participant& participant) const;
  /// @return whether it left without a word, which a stopped process does, at most within_s ago
  bool fell_silent(const Participant& participant, double within_s) const;

  /// What a participant says of its own nodes; kept as long as it is known.
  void tell_ros_nodes(const rtps::GuidPrefix_t& participant, std::vector<std::string> names);

  std::shared_ptr<wire::Handshakes> handshakes{};  // null without DDS Security
  RosGraph* ros_graph = nullptr;                   // is told of peers of Iron and later

 private:
  /// @return whether the endpoint is one of ros_discovery_info, which no list shows
  template <typename Info>
  bool is_ros_discovery(const Info& info) const;
  bool tell_handshakes(const rtps::ParticipantDiscoveryInfo& found) const;

  mutable std::mutex mutex_;
  std::map<std::string, ParticipantInfo> participants_;
  std::map<std::string, EndpointInfo> endpoints_;
  std::map<std::string, std::chrono::steady_clock::time_point> silent_since_;
  std::map<std::string, std::vector<std::string>> ros_nodes_;  // by participant
};

/// Reads ros_discovery_info.
class RosNodesListener : public dds::DataReaderListener {
 public:
  explicit RosNodesListener(DiscoveryListener& told) : told_(told) {}
  void on_data_available(dds::DataReader* reader) override;

 private:
  DiscoveryListener& told_;
};

struct Context::Impl {
  int domain = 0;
  std::shared_ptr<wire::Refusals> refusals = std::make_shared<wire::Refusals>();
  std::shared_ptr<wire::SenderTable> senders = std::make_shared<wire::SenderTable>();
  bool has_permissions = false;  // DDS Security decides who may write what
  RosGraph ros_graph;
  DiscoveryListener listener;
  RosNodesListener ros_nodes{listener};
  dds::DomainParticipant* participant = nullptr;
  dds::Publisher* publisher = nullptr;
  dds::Subscriber* subscriber = nullptr;

  ~Impl();
  /// The topic object of that name, made at first use. @return nullptr if it exists with
  /// another type
  dds::Topic* topic(const std::string& ros_name, const dds::TypeSupport& type);
  /// As topic(), of any name on the wire.
  dds::Topic* wire_topic(const std::string& name, const dds::TypeSupport& type);
  /// Begins to tell ROS 2 of the nodes. @return io_failed if the middleware gives no writer
  Status open_ros_graph(const ContextOptions& options);
  /// Why no reader or writer could be made: the middleware does not say.
  std::string why_no_endpoint() const;

 private:
  std::mutex topics_mutex_;
};

/// "/uav1/path" to "rt/uav1/path".
inline std::string wire_topic_name(std::string_view ros_name) {
  return "rt" + std::string(ros_name);
}

}  // namespace goshawk::runtime
