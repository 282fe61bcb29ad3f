#include "session.hpp"

#include <gtest/gtest.h>

namespace goshawk::viewer_bridge {
namespace {

using Kind = ClientEvent::Kind;

bool three_channels(std::uint32_t id) {
  return id >= 1 && id <= 3;
}

TEST(Session, SubscribesAndUnsubscribes) {
  Session session(7);
  const auto answer = session.on_text(
      R"({"op":"subscribe","subscriptions":[{"id":40,"channelId":2},{"id":41,"channelId":9}]})",
      three_channels);
  EXPECT_EQ(answer.close, "");
  ASSERT_EQ(answer.events.size(), 1u);
  EXPECT_EQ(answer.events[0].kind, Kind::subscribed);
  EXPECT_EQ(answer.events[0].channel, 2u);
  EXPECT_EQ(answer.events[0].client, 7u);
  ASSERT_EQ(answer.warnings.size(), 1u);
  EXPECT_EQ(answer.warnings[0], "there is no channel 9");
  ASSERT_NE(session.subscription(2), nullptr);
  EXPECT_EQ(*session.subscription(2), 40u);
  EXPECT_EQ(session.subscription(1), nullptr);
  session.on_text(R"({"op":"unsubscribe","subscriptionIds":[40]})", three_channels);
  EXPECT_EQ(session.subscription(2), nullptr);
}

TEST(Session, HandsOverWhatIsPublishedOnAnAdvertisedChannel) {
  Session session(1);
  const auto advertised = session.on_text(
      R"({"op":"advertise","channels":[{"id":258,"topic":"goal_pose","encoding":"json",)"
      R"("schemaName":"geometry_msgs/msg/PoseStamped"}]})",
      three_channels);
  ASSERT_EQ(advertised.events.size(), 1u);
  EXPECT_EQ(advertised.events[0].kind, Kind::advertised);
  const auto published = session.on_binary(std::string("\x01\x02\x01\x00\x00{}", 7));
  ASSERT_EQ(published.events.size(), 1u);
  EXPECT_EQ(published.events[0].kind, Kind::published);
  EXPECT_EQ(published.events[0].topic, "goal_pose");
  EXPECT_EQ(published.events[0].encoding, "json");
  EXPECT_EQ(published.events[0].bytes, (std::vector<unsigned char>{'{', '}'}));
  session.on_text(R"({"op":"unadvertise","channelIds":[258]})", three_channels);
  EXPECT_EQ(session.on_binary(std::string("\x01\x02\x01\x00\x00{}", 7)).events.size(), 0u);
}

TEST(Session, AsksWhoeverSendsGarbageToGo) {
  for (const char* garbage :
       {"", "garbage", "[]", "{}", "null", R"({"op":7})", R"({"op":"subscribe"})",
        R"({"op":"subscribe","subscriptions":[{"id":"x","channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":1e30,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"subscribe","subscriptions":{"id":1}})", R"({"op":"advertise","channels":[{}]})",
        "\xff\xfe", "{\"op\":\"\xff\"}"}) {
    Session session(1);
    const auto answer = session.on_text(garbage, three_channels);
    EXPECT_TRUE(!answer.close.empty() || !answer.warnings.empty()) << garbage;
    EXPECT_TRUE(answer.events.empty()) << garbage;
  }
  for (const auto& bytes : {std::string(), std::string(1, '\x01'), std::string("\x02\0\0\0\0", 5),
                            std::string(1000, '\xff')}) {
    Session session(1);
    EXPECT_NE(session.on_binary(bytes).close, "");
  }
}

TEST(Session, CountsMessagesOfASecond) {
  Session session(1);
  const auto now = std::chrono::steady_clock::now();
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(session.within_rate(10, now));
  EXPECT_FALSE(session.within_rate(10, now));
  EXPECT_TRUE(session.within_rate(10, now + std::chrono::milliseconds(1100)));
}

}  // namespace
}  // namespace goshawk::viewer_bridge
