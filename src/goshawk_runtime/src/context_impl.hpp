#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include <map>
#include <mutex>

#include "goshawk/runtime/context.hpp"
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

  std::vector<ParticipantInfo> participants() const;
  std::vector<EndpointInfo> endpoints() const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, ParticipantInfo> participants_;
  std::map<std::string, EndpointInfo> endpoints_;
};

struct Context::Impl {
  int domain = 0;
  std::shared_ptr<wire::Refusals> refusals = std::make_shared<wire::Refusals>();
  DiscoveryListener listener;
  dds::DomainParticipant* participant = nullptr;
  dds::Publisher* publisher = nullptr;
  dds::Subscriber* subscriber = nullptr;

  ~Impl();
  /// The topic object of that name, made at first use. @return nullptr if it exists with
  /// another type
  dds::Topic* topic(const std::string& ros_name, const dds::TypeSupport& type);

 private:
  std::mutex topics_mutex_;
};

/// "/uav1/path" to "rt/uav1/path".
inline std::string wire_topic_name(std::string_view ros_name) {
  return "rt" + std::string(ros_name);
}

}  // namespace goshawk::runtime
