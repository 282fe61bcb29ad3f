#include <gmock/gmock.h>

#include "domain.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"
#include "visualization_msgs.h"

namespace goshawk::runtime {
namespace {

using goshawk_msgs::msg::VehicleStatus;
using runtime_test::join;
using runtime_test::spin_until;
using Bytes = std::vector<unsigned char>;

/// Writes raw bytes under the name of a real type, then a good message, and expects the good one.
class Hostile : public testing::Test {
 protected:
  template <typename Message>
  void survives(const std::vector<Bytes>& payloads, const Message& good) {
    int got = 0;
    Message last;
    victim_.subscribe<Message>("target", Qos::reliable_last(1000),
                               [&](const Message& m, const auto&) {
                                 last = m;
                                 ++got;
                               });
    const auto type = raw_message_type(message_type<Message>().name());
    const auto attacker = attacker_.advertise_raw("target", type, Qos::reliable_last(1000));
    ASSERT_TRUE(spin_until(victim_, [&] { return attacker.matched() > 0; }));
    const Bytes good_bytes = encode(good);
    for (const auto& payload : payloads) {
      (void)attacker.publish_raw(&payload);
      ASSERT_TRUE(attacker.publish_raw(&good_bytes));
    }
    // All were queued before the first take: none of the good ones may get lost behind a bad one.
    EXPECT_TRUE(spin_until(victim_, [&] { return got >= int(payloads.size()); }))
        << got << " of " << payloads.size() << " good messages";
    EXPECT_EQ(last, good);
  }

  std::unique_ptr<Context> context_a_ = join();
  std::unique_ptr<Context> context_b_ = join();
  Node attacker_{*context_a_, "attacker"};
  Node victim_{*context_b_, "victim"};
};

TEST_F(Hostile, BytesThatAreNoMessage) {
  VehicleStatus good;
  good.header().frame_id("map");
  good.command_age(0.5);
  const Bytes bytes = encode(good);
  std::vector<Bytes> payloads = {
      {}, {0}, {0, 1}, {0, 1, 0, 0}, Bytes(5, 0xff), Bytes(10'000, 0xff)};
  for (std::size_t n = 4; n < bytes.size(); n += 3) {
    payloads.emplace_back(bytes.begin(), bytes.begin() + long(n));
  }
  Bytes bad_bool = bytes;
  bad_bool[4 + 8 + 4 + 4] = 7;  // stamp, length of "map", its characters
  payloads.push_back(bad_bool);
  for (const unsigned char kind : {2, 3, 7, 0x55, 255}) {  // encapsulations that are none of ours
    payloads.push_back(bytes);
    payloads.back()[1] = kind;
  }
  survives(payloads, good);
}

TEST_F(Hostile, LengthsOfABillion) {
  nav_msgs::msg::Path good;
  good.header().frame_id("map");
  good.poses().resize(3);
  Bytes text = encode(good), sequence = encode(good);
  for (int i = 0; i < 4; ++i) {
    text[std::size_t(12 + i)] = sequence[std::size_t(20 + i)] =
        (unsigned char)(1'000'000'000 >> 8 * i);
  }
  survives({text, sequence}, good);
}

TEST(Decode, SaysNoToTheBadBool) {
  VehicleStatus good, out;
  Bytes bytes = encode(good);
  EXPECT_TRUE(decode(bytes, out));
  bytes[4 + 8 + 4 + 1] = 7;
  EXPECT_FALSE(decode(bytes, out));
  for (const Bytes& none : {Bytes{}, Bytes{0}, Bytes{0, 1, 0, 0}}) EXPECT_FALSE(decode(none, out));
}

TEST(Decode, SurvivesRandomBytes) {
  Random random(1);
  visualization_msgs::msg::MarkerArray out;
  for (int i = 0; i < 2000; ++i) {
    Bytes bytes = {0, (unsigned char)(random.below(2)), 0, 0};
    for (int n = random.below(200); n > 0; --n)
      bytes.push_back((unsigned char)(random.below(3) == 0 ? random.below(256) : 0));
    (void)decode(bytes, out);
  }
}

}  // namespace
}  // namespace goshawk::runtime
