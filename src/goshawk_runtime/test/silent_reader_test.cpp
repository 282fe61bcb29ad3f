// What a writer of states does while a reliable reader confirms nothing: a plain participant of
// Fast DDS whose receiving thread stands still.

#include <gmock/gmock.h>

#include <condition_variable>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <mutex>

#include "domain.hpp"
#include "ros_peer.hpp"
#include "std_msgs.h"
#include "std_msgsPubSubTypes.h"

namespace goshawk::runtime {
namespace {

namespace dds = eprosima::fastdds::dds;
using std_msgs::msg::String;

/// Reliable, of rt/state. From its first message until go_on() its participant receives nothing.
class SilentReader : public dds::DataReaderListener {
 public:
  explicit SilentReader(dds::DomainParticipant& participant) : participant_(participant) {
    dds::TypeSupport type(new std_msgs::msg::StringPubSubType);
    type.register_type(&participant_);
    auto* topic =
        participant_.create_topic("rt/state", type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
    auto qos = dds::DATAREADER_QOS_DEFAULT;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    subscriber_ = participant_.create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    reader_ = subscriber_->create_datareader(topic, qos, this, dds::StatusMask::data_available());
  }
  ~SilentReader() override {
    go_on();
    subscriber_->delete_datareader(reader_);
  }
  SilentReader(const SilentReader&) = delete;
  SilentReader& operator=(const SilentReader&) = delete;

  void on_data_available(dds::DataReader* reader) override {
    std::unique_lock lock(mutex_);
    is_silent_ = !goes_on_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return goes_on_; });
    is_silent_ = false;
    String message;
    dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) ==
           eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) newest_ = message.data();
    }
  }
  bool is_silent() {
    const std::lock_guard lock(mutex_);
    return is_silent_;
  }
  void go_on() {
    const std::lock_guard lock(mutex_);
    goes_on_ = true;
    changed_.notify_all();
  }
  std::string newest() {
    const std::lock_guard lock(mutex_);
    return newest_;
  }

 private:
  dds::DomainParticipant& participant_;
  dds::Subscriber* subscriber_ = nullptr;
  dds::DataReader* reader_ = nullptr;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_silent_ = false;
  bool goes_on_ = false;
  std::string newest_;
};

TEST(States, AreNotHeldBackByAReliableReaderThatConfirmsNothing) {
  const auto context = runtime_test::join({"/node"});
  Node node(*context, "node");
  const auto states = node.advertise<String>("state", Qos::state());
  runtime_test::RosPeer peer(runtime_test::domain(), false);
  SilentReader reader(peer.participant());
  const auto say = [&](const std::string& data) {
    String message;
    message.data(data);
    return states.publish(message).ok();
  };
  ASSERT_TRUE(runtime_test::spin_until(node, [&] { return say("first") && reader.is_silent(); }));
  // A writer that waited would give up after 0.1 s each, with io_failed.
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(say(std::to_string(i))) << i;
  EXPECT_TRUE(reader.is_silent());
  reader.go_on();
  EXPECT_TRUE(runtime_test::spin_until(node, [&] { return reader.newest() == "1999"; }));
}

}  // namespace
}  // namespace goshawk::runtime
