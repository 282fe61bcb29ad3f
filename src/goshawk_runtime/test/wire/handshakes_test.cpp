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

struct Met : testing::Test {
  Met() {
    handshakes.begin(kOwn);
    handshakes.discovered(kOther, {});
  }
  Handshakes handshakes;
  const int way = 0, second_way = 0;
};

TEST(HandshakeDatagrams, AreAdmitted) {
  EXPECT_EQ(wire::fault_of(wire::make_greeting(kOther, kOwn)), "");
  EXPECT_EQ(wire::fault_of(wire::make_farewell(kOther)), "");
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

TEST_F(Met, AGreeterWithWhomAHandshakeWasFinishedIsForgotten) {
  const auto greeting = wire::make_greeting(kOther, kOwn);
  EXPECT_FALSE(handshakes.must_forget(greeting)) << "both have just met";
  handshakes.authorized(kOther);
  EXPECT_FALSE(handshakes.must_forget(wire::make_greeting(kOther, kThird)));
  EXPECT_FALSE(handshakes.must_forget(wire::make_greeting(kThird, kOwn)));
  EXPECT_TRUE(handshakes.must_forget(greeting));
  handshakes.left(kOther);
  EXPECT_FALSE(handshakes.must_forget(greeting));
}

TEST_F(Met, ASecondRequestThatIsNotTheFirstSentAgainBeginsAnew) {
  EXPECT_FALSE(handshakes.must_forget(message(5, kOwn)));
  EXPECT_FALSE(handshakes.must_forget(message(5, kOwn)));
  EXPECT_FALSE(handshakes.must_forget(message(6, kOwn, kOwn))) << "an answer";
  EXPECT_FALSE(handshakes.must_forget(message(7, kThird)));
  EXPECT_TRUE(handshakes.must_forget(message(8, kOwn)));
  handshakes.left(kOther);
  handshakes.discovered(kOther, {});
  EXPECT_FALSE(handshakes.must_forget(message(8, kOwn)));
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
  EXPECT_FALSE(handshakes.must_forget(message(5, kOwn)));
  EXPECT_EQ(handshakes.greetings(&way, 9 * kSecond).size(), 0U);
}

TEST(Handshakes, NothingIsGreetedBeforeTheParticipantHasAName) {
  Handshakes handshakes;
  handshakes.discovered(kOther, {});
  handshakes.authorized(kOther);
  const int way = 0;
  EXPECT_FALSE(handshakes.must_forget(wire::make_greeting(kOther, kOwn)));
  EXPECT_EQ(handshakes.greetings(&way, kSecond).size(), 0U);
}

}  // namespace
}  // namespace goshawk::runtime
