// Strangers that send datagrams to participants of this process.

#include <gmock/gmock.h>

#include <mutex>

#include "../domain.hpp"
#include "../stranger.hpp"
#include "datagram.hpp"
#include "std_msgs.h"

namespace goshawk::runtime {
namespace {

using runtime_test::Body;
using runtime_test::Datagram;
using runtime_test::RawBytes;
using runtime_test::spin_until;
using std_msgs::msg::String;
using testing::HasSubstr;

/// What one participant gets from others.
class Heard {
 public:
  void add(std::span<const std::byte> datagram, bool sent) {
    if (sent || datagram.size() < 20) return;
    const std::lock_guard lock(mutex_);
    all_.emplace_back(datagram.begin(), datagram.end());
  }
  std::vector<RawBytes> all() const {
    const std::lock_guard lock(mutex_);
    return all_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<RawBytes> all_;
};

class ReceiveFilter : public testing::Test {
 protected:
  static std::unique_ptr<Context> join(Heard* heard = nullptr) {
    ContextOptions options;
    options.domain = runtime_test::domain();
    if (heard != nullptr) {
      options.tap = [heard](auto datagram, bool sent) { heard->add(datagram, sent); };
    }
    return *Context::create(options);
  }
  /// One message, there and back: the topics are alive.
  void expect_talk() {
    const int before = got_;
    EXPECT_TRUE(spin_until(listener_, [&] {
      (void)speaker_out_.publish({});
      return got_ > before + 1;
    }));
  }
  bool refuses_one_more_than(std::uint64_t before) {
    return spin_until(listener_, [&] { return victim_->refused_datagrams() > before; });
  }

  Heard heard_;
  std::unique_ptr<Context> peer_ = join();
  std::unique_ptr<Context> victim_ = join(&heard_);
  Node speaker_{*peer_, "speaker"};
  Node listener_{*victim_, "listener"};
  int got_ = 0;
  Publisher<String> speaker_out_ = speaker_.advertise<String>("t", Qos::reliable_last());
  std::shared_ptr<void> subscribed_ =
      (listener_.subscribe<String>("t", Qos::reliable_last(),
                                   [&](const auto&, const auto&) { ++got_; }),
       nullptr);
  runtime_test::Stranger stranger_;
};

TEST_F(ReceiveFilter, OutlivesTheDatagramThatEndsFastDds) {
  expect_talk();
  stranger_.send_to_all(Datagram().add(0x80, Body().zeros(57), 0, 56).bytes());
  EXPECT_TRUE(refuses_one_more_than(0));
  EXPECT_THAT(victim_->last_refusal(), HasSubstr("Fast DDS' own is not the last, from"));
  expect_talk();
}

TEST_F(ReceiveFilter, HoldsParticipantsToTheirPort) {
  expect_talk();
  const auto heard = heard_.all();
  ASSERT_FALSE(heard.empty());
  const auto before = victim_->refused_datagrams();
  stranger_.send_to_all(heard.back());
  EXPECT_TRUE(refuses_one_more_than(before));
  EXPECT_THAT(victim_->last_refusal(), HasSubstr("sends from another port"));
}

// RTPS lets any sender that names a participant say that it has left.
TEST_F(ReceiveFilter, KeepsAPeerThatAStrangerSaysHasLeft) {
  expect_talk();
  const auto heard = heard_.all();
  const auto is_news = [](const RawBytes& d) {  // a participant's announcement
    const std::byte writer[] = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0xc2}};
    return !std::ranges::search(d, writer).empty();
  };
  const auto news = std::ranges::find_if(heard, is_news);
  ASSERT_NE(news, heard.end());
  RawBytes left(news->begin(), news->begin() + 20);
  const Body prefix = [&] {
    Body b;
    b.bytes.assign(news->begin() + 8, news->begin() + 20);
    return b;
  }();
  const Body guid = Body(prefix).entity(0x000001c1);
  const Body qos = Body().parameter(0x70, guid).parameter(0x71, Body().zeros(3).u8(3));
  const Body data = Body()
                        .u16(0)
                        .u16(16)
                        .entity(0x000100c7)
                        .entity(0x000100c2)
                        .sequence_number(1000)
                        .append(qos)
                        .u16(1)
                        .u16(0);
  Datagram forged;
  forged.add(21, data, 2);
  left.insert(left.end(), forged.bytes().begin() + 20, forged.bytes().end());
  const auto before = victim_->refused_datagrams();
  const auto peers = victim_->participants().size();
  stranger_.send_to_all(left);
  EXPECT_TRUE(refuses_one_more_than(before));
  EXPECT_EQ(victim_->participants().size(), peers);
  expect_talk();
}

}  // namespace
}  // namespace goshawk::runtime
