#include <gtest/gtest.h>

#include "../../src/wire/datagram_check.hpp"
#include "../../src/wire/handshake_datagrams.hpp"
#include "../../src/wire/handshakes.hpp"
#include "datagram.hpp"

namespace goshawk::runtime {
namespace {

using namespace runtime_test;
using wire::Handshakes;
using Prefix = Handshakes::Prefix;

constexpr std::uint32_t kHandshakeReader = 0x000201c4, kHandshakeWriter = 0x000201c3;
constexpr std::uint32_t kDiscoveryReader = 0x000100c7, kDiscoveryWriter = 0x000100c2;
constexpr std::int64_t kSecond = 1'000'000'000;

// As the header that Datagram writes.
Prefix prefix_ending_with(std::uint8_t last) {
  Prefix prefix{};
  prefix.back() = std::byte{last};
  return prefix;
}

const Prefix kOwn = prefix_ending_with(1), kOther = prefix_ending_with(7),
             kThird = prefix_ending_with(9);

Body guid(const Prefix& prefix) {
  Body body;
  body.bytes.assign(prefix.begin(), prefix.end());
  return body.entity(0x000001c1);
}

// A message of the handshake from kOther. @param answers what it answers; nothing: a request
RawBytes message(std::int64_t number, const Prefix& to, const Prefix& answers = {}) {
  Body body;
  body.u16(0).u16(16).entity(kHandshakeReader).entity(kHandshakeWriter).sequence_number(3);
  body.u16(0x0100).u16(0);  // encapsulation, little-endian
  body.append(guid(kOther)).sequence_number(number);
  body.append(answers == Prefix{} ? Body().zeros(16) : guid(answers)).sequence_number(0);
  body.append(guid(to)).zeros(32).text("dds.sec.auth").u32(0);
  return Datagram(0x010f, 7).add(kInfoTime, Body().zeros(8)).add(kData, body, kHasData).bytes();
}

// What kOther says of itself every now and then: a lease of 3 s.
RawBytes announcement(std::int64_t number = 1) {
  Body body;
  body.u16(0).u16(16).entity(kDiscoveryReader).entity(kDiscoveryWriter).sequence_number(number);
  body.u16(0x0300).u16(0);  // encapsulation: a list of parameters, little-endian
  body.parameter(0x0050, guid(kOther)).parameter(0x0002, Body().u32(3).u32(0));
  body.u16(1).u16(0);
  return Datagram(0x010f, 7).add(kInfoTime, Body().zeros(8)).add(kData, body, kHasData).bytes();
}

// @param flags which it has besides
RawBytes farewell(std::uint8_t status = 3, unsigned flags = kHasKey) {
  Body body;
  body.u16(0).u16(16).entity(kDiscoveryReader).entity(kDiscoveryWriter).sequence_number(2);
  body.parameter(0x0070, guid(kOther)).parameter(0x0071, Body().zeros(3).u8(status));
  body.u16(1).u16(0);
  body.u16(0x0300).u16(0).parameter(0x0050, guid(kOther)).u16(1).u16(0);
  return Datagram(0x010f, 7).add(kData, body, kInlineQos | flags).bytes();
}

struct Met : testing::Test {
  Met() {
    handshakes.begin(kOwn);
    handshakes.discovered(kOther, {});
  }
  bool forgets(const RawBytes& datagram) { return !handshakes.take_in(datagram).passes; }

  Handshakes handshakes;
  const int way = 0, second_way = 0;
};

TEST(HandshakeDatagrams, AreAdmitted) {
  EXPECT_EQ(wire::fault_of(wire::make_greeting(kOther, kOwn)), "");
  EXPECT_EQ(wire::fault_of(announcement()), "");
  EXPECT_EQ(wire::fault_of(farewell()), "");
  EXPECT_EQ(wire::fault_of(wire::make_brief(announcement())), "");
  EXPECT_EQ(wire::fault_of(message(1, kOwn)), "");
}

TEST(HandshakeDatagrams, AGreetingIsForOneParticipant) {
  const auto greeting = wire::make_greeting(kOther, kOwn);
  EXPECT_TRUE(wire::is_greeting(greeting, kOwn));
  EXPECT_FALSE(wire::is_greeting(greeting, kThird));
  EXPECT_FALSE(wire::is_greeting(message(1, kOwn), kOwn));
  for (std::size_t size = 20; size < greeting.size(); ++size) {
    EXPECT_FALSE(wire::is_greeting(std::span(greeting).first(size), kOwn)) << size;
  }
}

TEST(HandshakeDatagrams, AMessageIsReadByItsReceiverAlone) {
  const auto request = wire::handshake_message(message(5, kOwn), kOwn);
  ASSERT_TRUE(request);
  EXPECT_TRUE(request->is_request);
  EXPECT_EQ(request->number, 5);
  const auto reply = wire::handshake_message(message(6, kOwn, kOwn), kOwn);
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->is_request);
  EXPECT_FALSE(wire::handshake_message(message(5, kThird), kOwn));
  EXPECT_FALSE(wire::handshake_message(wire::make_greeting(kOther, kOwn), kOwn));
}

TEST(HandshakeDatagrams, AnnouncementsAndFarewellsAreToldApart) {
  EXPECT_TRUE(wire::is_announcement(announcement()));
  EXPECT_FALSE(wire::is_farewell(announcement()));
  EXPECT_FALSE(wire::is_announcement(farewell()));
  EXPECT_TRUE(wire::is_farewell(farewell()));
  EXPECT_TRUE(wire::is_farewell(farewell(3, kHasData))) << "whole data, but disposed";
  EXPECT_FALSE(wire::is_farewell(farewell(0, kHasData))) << "inline QoS of another kind";
  for (const RawBytes& other : {message(1, kOwn), wire::make_greeting(kOther, kOwn)}) {
    EXPECT_FALSE(wire::is_announcement(other));
    EXPECT_FALSE(wire::is_farewell(other));
  }
}

// Others may stand before and behind it in the same datagram.
TEST(HandshakeDatagrams, ABriefAnnouncementDiffersInItsNumberAndItsLeaseAlone) {
  const RawBytes whole = announcement();
  RawBytes more = whole;
  const RawBytes behind = message(1, kOwn);
  more.insert(more.end(), behind.begin() + 20, behind.end());
  const auto brief = wire::make_brief(whole);
  EXPECT_EQ(wire::make_brief(more), brief);
  EXPECT_TRUE(wire::is_announcement(brief));
  const std::size_t time_size = 12, number_at = 20 + 4 + 12, lease_at = number_at + 8 + 4 + 20 + 4;
  ASSERT_EQ(brief.size(), whole.size() - time_size);
  for (std::size_t i = 0; i < brief.size(); ++i) {
    const bool is_number = i >= number_at && i < number_at + 8;
    const bool is_lease = i >= lease_at && i < lease_at + 8;
    const std::byte before = whole[i < 20 ? i : i + time_size];
    if (is_number || is_lease) continue;
    EXPECT_EQ(brief[i], before) << i;
  }
  EXPECT_EQ(brief[lease_at], std::byte{0}) << "seconds";
  EXPECT_GT(std::to_integer<int>(brief[lease_at + 7]), 0) << "but not nothing";
}

TEST_F(Met, AGreeterWithWhomAHandshakeWasFinishedIsForgotten) {
  const auto greeting = wire::make_greeting(kOther, kOwn);
  EXPECT_FALSE(forgets(greeting)) << "both have just met";
  handshakes.authorized(kOther);
  EXPECT_FALSE(forgets(wire::make_greeting(kOther, kThird)));
  EXPECT_FALSE(forgets(wire::make_greeting(kThird, kOwn)));
  EXPECT_TRUE(forgets(greeting));
  EXPECT_TRUE(handshakes.left(kOther));
  EXPECT_FALSE(forgets(greeting));
}

TEST_F(Met, ASecondRequestThatIsNotTheFirstSentAgainBeginsAnew) {
  EXPECT_FALSE(forgets(message(5, kOwn)));
  EXPECT_FALSE(forgets(message(5, kOwn)));
  EXPECT_FALSE(forgets(message(6, kOwn, kOwn))) << "an answer";
  EXPECT_FALSE(forgets(message(7, kThird)));
  EXPECT_TRUE(forgets(message(8, kOwn)));
  handshakes.left(kOther);
  handshakes.discovered(kOther, {});
  EXPECT_FALSE(forgets(message(8, kOwn)));
}

TEST_F(Met, WhoTakesLeaveIsAnnouncedBrieflyAndNotHeardUntilItIsForgotten) {
  EXPECT_FALSE(forgets(announcement()));
  const auto intake = handshakes.take_in(farewell());
  EXPECT_FALSE(intake.passes);
  EXPECT_EQ(intake.instead, wire::make_brief(announcement()));
  for (const RawBytes& later : {announcement(), message(5, kOwn), farewell()}) {
    const auto none = handshakes.take_in(later);
    EXPECT_FALSE(none.passes);
    EXPECT_TRUE(none.instead.empty());
  }
  EXPECT_TRUE(handshakes.left(kOther)) << "it did not fall silent";
  EXPECT_FALSE(forgets(announcement()));
}

TEST_F(Met, WhoNeverAnnouncedItselfIsNotHeardAfterItsFarewell) {
  const auto intake = handshakes.take_in(farewell());
  EXPECT_FALSE(intake.passes);
  EXPECT_TRUE(intake.instead.empty());
  EXPECT_TRUE(forgets(announcement()));
}

TEST_F(Met, FarewellsOfStrangersPassNowhere) {
  handshakes.left(kOther);
  EXPECT_TRUE(forgets(farewell()));
  EXPECT_FALSE(forgets(announcement()));
}

TEST_F(Met, WhoFallsSilentHasTakenNoLeave) {
  EXPECT_FALSE(forgets(announcement()));
  EXPECT_FALSE(handshakes.left(kOther));
}

TEST_F(Met, EachIsGreetedOnceThroughEachWay) {
  const auto due = handshakes.greetings(&way, kSecond);
  ASSERT_EQ(due.size(), 1U);
  EXPECT_EQ(due[0].to, kOther);
  EXPECT_EQ(handshakes.greetings(&way, kSecond + 1).size(), 0U);
  EXPECT_EQ(handshakes.greetings(&second_way, kSecond + 1).size(), 1U);
  handshakes.discovered(kThird, {});
  EXPECT_EQ(handshakes.greetings(&way, kSecond + 2).size(), 1U);
}

TEST_F(Met, AGreetingIsRepeatedUntilAnAnswerComes) {
  EXPECT_EQ(handshakes.greetings(&way, kSecond).size(), 1U);
  EXPECT_EQ(handshakes.greetings(&way, 3 * kSecond).size(), 0U);
  EXPECT_EQ(handshakes.greetings(&way, 5 * kSecond).size(), 1U);
  EXPECT_FALSE(forgets(message(5, kOwn)));
  EXPECT_EQ(handshakes.greetings(&way, 9 * kSecond).size(), 0U);
}

TEST(Handshakes, NothingIsGreetedBeforeTheParticipantHasAName) {
  Handshakes handshakes;
  handshakes.discovered(kOther, {});
  handshakes.authorized(kOther);
  const int way = 0;
  EXPECT_TRUE(handshakes.take_in(wire::make_greeting(kOther, kOwn)).passes);
  EXPECT_EQ(handshakes.greetings(&way, kSecond).size(), 0U);
}

}  // namespace
}  // namespace goshawk::runtime
