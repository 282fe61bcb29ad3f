#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <array>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace goshawk::runtime_test {

using Bytes = std::vector<unsigned char>;
using Gid16 = std::array<std::uint8_t, 16>;

/// A node as ros_discovery_info tells it; each gid cut to its first 16 bytes.
struct ToldNode {
  std::string node_namespace, name;
  std::vector<Gid16> readers, writers;
};
struct ToldParticipant {
  Gid16 gid{};
  std::vector<ToldNode> nodes;
  const ToldNode* node(const std::string& name) const;
};

/// Decodes with Fast CDR alone. @throws what Fast CDR throws; std::runtime_error if bytes are left
ToldParticipant decode(Bytes payload, int gid_bytes);

/// A process of ROS 2, of Fast DDS alone: it reads and writes ros_discovery_info as bytes. On
/// loopback.
class RosPeer : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  /// @param typehash as Iron and later tell it of their endpoints
  RosPeer(int domain, bool typehash);
  ~RosPeer() override;

  Gid16 gid() const;
  eprosima::fastdds::dds::DomainParticipant& participant() { return *participant_; }
  void say(const Bytes& payload);
  /// The newest message of another participant; empty: none yet.
  const Bytes& newest();
  /// The GUID of who writes or reads a topic; zeros: nobody yet.
  Gid16 found(const std::string& topic, bool writer);

  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;

 private:
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::DataWriter* writer_ = nullptr;
  eprosima::fastdds::dds::DataReader* reader_ = nullptr;
  Bytes newest_;
  std::mutex mutex_;
  std::map<std::pair<std::string, bool>, Gid16> found_;
};

}  // namespace goshawk::runtime_test
