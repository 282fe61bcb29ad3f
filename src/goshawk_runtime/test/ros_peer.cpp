#include "ros_peer.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <stdexcept>

namespace goshawk::runtime_test {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

class BytesType : public dds::TopicDataType {
 public:
  BytesType() {
    setName("rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_");
    m_typeSize = 4096;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<const Bytes*>(data);
    std::ranges::copy(bytes, payload->data);
    payload->length = unsigned(bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return std::uint32_t(static_cast<const Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

dds::DomainParticipantQos on_loopback() {
  dds::DomainParticipantQos qos;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back("127.0.0.1");
  udp->maxInitialPeersRange = 60;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  rtps::Locator_t peer;
  peer.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(peer);
  const std::string user_data = "enclave=/;";
  qos.user_data().data_vec().assign(user_data.begin(), user_data.end());
  return qos;
}

template <typename Qos>
Qos as_ros(Qos qos, bool typehash) {
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  const std::string user_data = typehash ? "typehash=RIHS01_" + std::string(64, 'a') + ";" : "";
  qos.user_data().data_vec().assign(user_data.begin(), user_data.end());
  return qos;
}

Gid16 gid_of(const rtps::GUID_t& guid) {
  Gid16 gid{};
  std::ranges::copy(guid.entityId.value, std::ranges::copy(guid.guidPrefix.value, gid.begin()).out);
  return gid;
}

}  // namespace

const ToldNode* ToldParticipant::node(const std::string& name) const {
  const auto at = std::ranges::find(nodes, name, &ToldNode::name);
  return at == nodes.end() ? nullptr : &*at;
}

ToldParticipant decode(Bytes payload, int gid_bytes) {
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload.data()), payload.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.read_encapsulation();
  const auto gid = [&] {
    std::vector<std::uint8_t> all(static_cast<std::size_t>(gid_bytes));
    cdr.deserializeArray(all.data(), all.size());
    if (std::ranges::any_of(all.begin() + 16, all.end(), [](auto b) { return b != 0; })) {
      throw std::runtime_error("a gid does not end with zeros");
    }
    Gid16 value{};
    std::copy_n(all.begin(), 16, value.begin());
    return value;
  };
  const auto gids = [&] {
    std::uint32_t count = 0;
    cdr >> count;
    std::vector<Gid16> list;
    while (list.size() < count) list.push_back(gid());
    return list;
  };
  ToldParticipant told{gid(), {}};
  std::uint32_t nodes = 0;
  cdr >> nodes;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    ToldNode node;
    cdr >> node.node_namespace >> node.name;
    node.readers = gids();
    node.writers = gids();
    told.nodes.push_back(node);
  }
  if (payload.size() - cdr.getSerializedDataLength() > 3)
    throw std::runtime_error("bytes are left");
  return told;
}

RosPeer::RosPeer(int domain, bool typehash) {
  participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
      dds::DomainId_t(domain), on_loopback(), this, dds::StatusMask::none());
  dds::TypeSupport type(new BytesType);
  type.register_type(participant_);
  auto* topic = participant_->create_topic("ros_discovery_info", type.get_type_name(),
                                           dds::TOPIC_QOS_DEFAULT);
  writer_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT)
                ->create_datawriter(topic, as_ros(dds::DATAWRITER_QOS_DEFAULT, typehash));
  auto reader_qos = as_ros(dds::DATAREADER_QOS_DEFAULT, typehash);
  reader_qos.history().kind = dds::KEEP_ALL_HISTORY_QOS;
  reader_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)
                ->create_datareader(topic, reader_qos);
}

RosPeer::~RosPeer() {
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

Gid16 RosPeer::gid() const {
  return gid_of(participant_->guid());
}

void RosPeer::say(const Bytes& payload) {
  Bytes copy = payload;
  if (!writer_->write(&copy)) throw std::runtime_error("not written");
}

const Bytes& RosPeer::newest() {
  Bytes bytes;
  dds::SampleInfo info;
  while (reader_->take_next_sample(&bytes, &info) ==
         eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
    const auto& from = info.sample_identity.writer_guid().guidPrefix;
    if (info.valid_data && from != participant_->guid().guidPrefix) newest_ = bytes;
  }
  return newest_;
}

Gid16 RosPeer::found(const std::string& topic, bool writer) {
  const std::lock_guard lock(mutex_);
  return found_[{topic, writer}];
}

void RosPeer::on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& info) {
  const std::lock_guard lock(mutex_);
  found_[{info.info.topicName().to_string(), true}] = gid_of(info.info.guid());
}

void RosPeer::on_subscriber_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& info) {
  const std::lock_guard lock(mutex_);
  found_[{info.info.topicName().to_string(), false}] = gid_of(info.info.guid());
}

}  // namespace goshawk::runtime_test
