#include "dds/link.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <algorithm>
#include <chrono>
#include <cstring>
#include <fastdds/dds/core/LoanableSequence.hpp>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <stdexcept>

#include "dds/block_type.hpp"

namespace goshawk::bench {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using ReturnCode = eprosima::fastrtps::types::ReturnCode_t;

constexpr unsigned kSocketBuffer = 4 << 20;  // [byte] as goshawk_runtime asks for
constexpr unsigned kSegment = 64 << 20;      // [byte] of shared memory: holds the largest map
constexpr std::uint32_t kHistory_byte =
    40'000'000;  // [byte] at most, of a writer's or reader's samples

// Samples that a writer and a reader hold.
int depth_of(std::uint32_t bytes) {
  return int(std::clamp<std::uint32_t>(kHistory_byte / bytes, 2, 50));
}

// Loopback without multicast, as goshawk_runtime has it; shared memory beside it where asked for.
dds::DomainParticipantQos participant_qos(const LinkOptions& options) {
  dds::DomainParticipantQos qos;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->sendBufferSize = udp->receiveBufferSize = kSocketBuffer;
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  if (options.way == "shared_memory") {
    auto memory = std::make_shared<eprosima::fastdds::rtps::SharedMemTransportDescriptor>();
    memory->segment_size(kSegment);
    qos.transport().user_transports.push_back(memory);
  }
  rtps::Locator_t peer;
  peer.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(peer);
  auto& discovery = qos.wire_protocol().builtin.discovery_config;
  discovery.initial_announcements = {5, {0, 50'000'000}};
  discovery.leaseDuration_announcementperiod = {0, 500'000'000};
  return qos;
}

template <typename EndpointQos>
void apply(const LinkOptions& options, Quality quality, EndpointQos& qos) {
  const int depth = depth_of(options.bytes);
  qos.reliability().kind = quality == Quality::best_effort ? dds::BEST_EFFORT_RELIABILITY_QOS
                                                           : dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind =
      quality == Quality::reliable_all ? dds::KEEP_ALL_HISTORY_QOS : dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = depth;
  qos.resource_limits().max_samples = depth;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = depth;
  qos.resource_limits().allocated_samples = depth;
  qos.endpoint().history_memory_policy = rtps::MemoryManagementPolicy_t::PREALLOCATED_MEMORY_MODE;
  if (options.way == "loans") {
    qos.data_sharing().automatic();
  } else {
    qos.data_sharing().off();
  }
}

Stamp stamp_of(const unsigned char* data) {
  Stamp stamp;
  std::memcpy(&stamp, data, sizeof stamp);
  return stamp;
}

}  // namespace

std::vector<std::string> ways() {
  return {"udp", "shared_memory", "loans", "one_process"};
}

std::int64_t steady_ns() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Member::Impl {
  LinkOptions options;
  dds::DomainParticipant* participant = nullptr;
  dds::Publisher* publisher = nullptr;
  dds::Subscriber* subscriber = nullptr;
  dds::TypeSupport type;

  dds::Topic* topic(const std::string& name) const {
    if (auto* found = participant->lookup_topicdescription(name)) {
      return static_cast<dds::Topic*>(found);
    }
    return participant->create_topic(name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
  }
};

Member::Member(const LinkOptions& options) : impl_(std::make_unique<Impl>()) {
  impl_->options = options;
  impl_->participant = dds::DomainParticipantFactory::get_instance()->create_participant(
      dds::DomainId_t(options.domain), participant_qos(options));
  if (impl_->participant == nullptr) throw std::runtime_error("cannot join the DDS domain");
  impl_->publisher = impl_->participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  impl_->subscriber = impl_->participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  impl_->type.reset(new BlockType(options.bytes));
  impl_->type.register_type(impl_->participant);
}

Member::~Member() {
  impl_->participant->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(impl_->participant);
}

struct Sender::Impl {
  Member::Impl& member;
  dds::DataWriter* writer = nullptr;
  std::vector<unsigned char> sample;

  // Written where the reader will find it.
  bool send_loan(const Stamp& stamp) {
    void* loan = nullptr;
    for (int tries = 0; tries < 1000; ++tries) {
      const auto got = writer->loan_sample(
          loan, dds::DataWriter::LoanInitializationKind::NO_LOAN_INITIALIZATION);
      if (got == ReturnCode::RETCODE_OK) break;
      loan = nullptr;  // every one is lent: the reader must give one back first
      writer->wait_for_acknowledgments({0, 1'000'000});
    }
    if (loan == nullptr) return false;
    // Filled whole, as who serialises would: a loan saves the copies, not the writing.
    std::memcpy(loan, sample.data(), sample.size());
    std::memcpy(loan, &stamp, sizeof stamp);
    if (writer->write(loan)) return true;
    writer->discard_loan(loan);
    return false;
  }
};

Sender::Sender(Member& member, const std::string& topic, Quality quality)
    : impl_(new Impl{member.impl(), nullptr, {}}) {
  const LinkOptions& options = impl_->member.options;
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  apply(options, quality, qos);
  qos.publish_mode().kind =
      options.asynchronous ? dds::ASYNCHRONOUS_PUBLISH_MODE : dds::SYNCHRONOUS_PUBLISH_MODE;
  qos.reliability().max_blocking_time = {1, 0};
  // A writer that keeps all waits for acknowledgements, which a heartbeat asks for.
  const bool keeps_all = quality == Quality::reliable_all;
  qos.reliable_writer_qos().times.heartbeatPeriod = {0, keeps_all ? 1'000'000U : 100'000'000U};
  impl_->writer = impl_->member.publisher->create_datawriter(impl_->member.topic(topic), qos);
  if (impl_->writer == nullptr) throw std::runtime_error("cannot create a writer");
  impl_->sample.resize(options.bytes);
}

Sender::~Sender() {
  impl_->member.publisher->delete_datawriter(impl_->writer);
}

bool Sender::send(Stamp stamp) {
  if (impl_->member.options.way == "loans") return impl_->send_loan(stamp);
  std::memcpy(impl_->sample.data(), &stamp, sizeof stamp);
  return impl_->writer->write(impl_->sample.data());
}

int Sender::matched() const {
  dds::PublicationMatchedStatus status;
  impl_->writer->get_publication_matched_status(status);
  return status.current_count;
}

struct Receiver::Impl : dds::DataReaderListener {
  Impl(Member::Impl& m, Callback c) : member(m), callback(std::move(c)) {}

  Member::Impl& member;
  Callback callback;
  dds::DataReader* reader = nullptr;
  dds::WaitSet wait_set;
  dds::ConditionSeq active;
  std::vector<unsigned char> sample;

  // It may be called before create_datareader() has returned.
  void on_data_available(dds::DataReader* from) override { take(*from); }

  void take(dds::DataReader& from) {
    member.options.way == "loans" ? take_loans(from) : take_copies(from);
  }

  void take_copies(dds::DataReader& from) {
    dds::SampleInfo info;
    while (from.take_next_sample(sample.data(), &info) == ReturnCode::RETCODE_OK) {
      if (info.valid_data) callback(stamp_of(sample.data()));
    }
  }

  void take_loans(dds::DataReader& from) {
    dds::LoanableSequence<unsigned char> samples;
    dds::SampleInfoSeq infos;
    while (from.take(samples, infos) == ReturnCode::RETCODE_OK) {
      for (dds::LoanableCollection::size_type i = 0; i < infos.length(); ++i) {
        if (infos[i].valid_data) callback(stamp_of(&samples[i]));
      }
      from.return_loan(samples, infos);
    }
  }
};

Receiver::Receiver(Member& member, const std::string& topic, Callback callback, Quality quality)
    : impl_(std::make_unique<Impl>(member.impl(), std::move(callback))) {
  const LinkOptions& options = impl_->member.options;
  impl_->sample.resize(options.bytes);
  dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
  apply(options, quality, qos);
  impl_->reader = impl_->member.subscriber->create_datareader(
      impl_->member.topic(topic), qos, options.listener ? impl_.get() : nullptr,
      dds::StatusMask::data_available());
  if (impl_->reader == nullptr) throw std::runtime_error("cannot create a reader");
  impl_->reader->get_statuscondition().set_enabled_statuses(dds::StatusMask::data_available());
  impl_->wait_set.attach_condition(impl_->reader->get_statuscondition());
}

Receiver::~Receiver() {
  impl_->wait_set.detach_condition(impl_->reader->get_statuscondition());
  impl_->reader->set_listener(nullptr);
  impl_->member.subscriber->delete_datareader(impl_->reader);
}

void Receiver::wait(double timeout_s) {
  if (impl_->member.options.listener) return;
  impl_->wait_set.wait(impl_->active,
                       eprosima::fastrtps::Duration_t(static_cast<long double>(timeout_s)));
  impl_->take(*impl_->reader);
}

int Receiver::matched() const {
  dds::SubscriptionMatchedStatus status;
  impl_->reader->get_subscription_matched_status(status);
  return status.current_count;
}

}  // namespace goshawk::bench
