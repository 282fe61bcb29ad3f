#include <gmock/gmock.h>

#include "../../src/wire/datagram_check.hpp"
#include "datagram.hpp"

namespace goshawk::runtime {
namespace {

using namespace runtime_test;
using testing::HasSubstr;
using testing::IsEmpty;
using wire::fault_of;

constexpr std::uint32_t kReader = 0x00000107, kWriter = 0x00000203;

std::string fault(const Datagram& d) {
  return std::string(fault_of(d.bytes()));
}

Body ends() {
  return Body().entity(kReader).entity(kWriter);
}
Body heartbeat(std::int64_t first, std::int64_t last) {
  return ends().sequence_number(first).sequence_number(last).u32(1);
}
Body gap(std::int64_t first, std::int64_t base, std::uint32_t bits = 0) {
  return ends().sequence_number(first).sequence_number(base).u32(bits).zeros((bits + 31) / 32 * 4);
}
Body acknack(std::int64_t base, std::uint32_t bits) {
  return ends().sequence_number(base).u32(bits).zeros((bits + 31) / 32 * 4).u32(1);
}
Body data(std::int64_t number = 1, std::uint16_t to_inline_qos = 16) {
  return Body().u16(0).u16(to_inline_qos).entity(kReader).entity(kWriter).sequence_number(number);
}
struct Fragment {
  std::uint32_t first = 1;
  std::uint16_t count = 1, size = 1024;
  std::uint32_t whole = 4096;
  std::size_t payload = 1024;
};
Body fragment(const Fragment& f) {
  return data(1, 28).u32(f.first).u16(f.count).u16(f.size).u32(f.whole).zeros(f.payload);
}

TEST(DatagramCheck, AdmitsWhatAStageSends) {
  Datagram d;
  d.add(kInfoDestination, Body().zeros(12));
  d.add(kInfoTime, Body().zeros(8));
  d.add(kData, data().zeros(64), kHasData);
  d.add(kDataFrag, fragment({}));
  d.add(kDataFrag, fragment({.first = 4, .whole = 4000, .payload = 928}));
  d.add(kHeartbeat, heartbeat(1, 0));
  d.add(kGap, gap(3, 5, 33));
  d.add(kAcknack, acknack(0, 0));
  d.add(kNackFrag, ends().sequence_number(1).u32(1).u32(8).zeros(4).u32(1));
  EXPECT_THAT(fault(d), IsEmpty());
  d.add(0x80, Body().zeros(56));  // Fast DDS' statistics end each datagram
  EXPECT_THAT(fault(d), IsEmpty());
}

// Of 81 bytes; it ended every participant of Debian 12.
TEST(DatagramCheck, RefusesStatisticsThatAreNotTheLast) {
  const Datagram killer = Datagram().add(0x80, Body().zeros(57), 0, 56);
  EXPECT_EQ(killer.bytes().size(), 81U);
  EXPECT_THAT(fault(killer), HasSubstr("not the last"));
  // Other vendors put submessages of their own anywhere.
  EXPECT_THAT(fault(Datagram(0x0110).add(0x80, Body().zeros(56)).add(kInfoTime, Body().zeros(8))),
              IsEmpty());
}

TEST(DatagramCheck, RefusesWhatIsNoRtps2) {
  EXPECT_THAT(std::string(fault_of({})), HasSubstr("header"));
  RawBytes bytes = Datagram().add(kHeartbeat, heartbeat(1, 1)).bytes();
  for (const std::size_t at : {0, 3, 4}) {
    RawBytes other = bytes;
    other[at] = std::byte{0x51};
    EXPECT_THAT(std::string(fault_of(other)), HasSubstr("header")) << at;
  }
  EXPECT_THAT(fault(Datagram(0x010f, 0)), HasSubstr("no sender"));
}

TEST(DatagramCheck, RefusesEveryCutThatIsNotBetweenSubmessages) {
  Datagram d;
  d.add(kInfoTime, Body().zeros(8)).add(kData, data().zeros(8), kHasData).add(kGap, gap(3, 5, 8));
  const RawBytes& whole = d.bytes();
  int admitted = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    admitted += wire::admits(std::span(whole).first(size)) ? 1 : 0;
  }
  EXPECT_EQ(admitted, 3);  // the header alone, and after each of the first two
}

TEST(DatagramCheck, RefusesALengthThatLeavesTheDatagramOrTheGrid) {
  EXPECT_THAT(fault(Datagram().add(kInfoTime, Body().zeros(8), 0, 12)), HasSubstr("past the end"));
  EXPECT_THAT(fault(Datagram().add(0x7f, Body().zeros(6)).add(kInfoTime, Body().zeros(8))),
              HasSubstr("past the end"));
  // Zero means all the rest.
  EXPECT_THAT(fault(Datagram().add(kData, data().zeros(8), kHasData, 0)), IsEmpty());
}

TEST(DatagramCheck, RefusesNumbersThatNoWriterReaches) {
  for (const auto& [first, last] : std::vector<std::pair<std::int64_t, std::int64_t>>{
           {0, -1}, {0, 0}, {-5, 5}, {5, 3}, {1, wire::kMostSequence}}) {
    EXPECT_THAT(fault(Datagram().add(kHeartbeat, heartbeat(first, last))), HasSubstr("HEARTBEAT"))
        << first << " " << last;
  }
  EXPECT_THAT(fault(Datagram().add(kData, data(0).zeros(8), kHasData)), HasSubstr("DATA"));
  EXPECT_THAT(fault(Datagram().add(kAcknack, acknack(1, 257))), HasSubstr("ACKNACK"));
  EXPECT_THAT(fault(Datagram().add(kAcknack, acknack(-1, 0))), HasSubstr("ACKNACK"));
}

TEST(DatagramCheck, RefusesAGapThatWouldTakeForEver) {
  EXPECT_THAT(fault(Datagram().add(kGap, gap(1, 1 + wire::kMostGap))), IsEmpty());
  EXPECT_THAT(fault(Datagram().add(kGap, gap(1, 2 + wire::kMostGap))), HasSubstr("too many"));
  EXPECT_THAT(fault(Datagram().add(kGap, gap(9, 8))), HasSubstr("GAP"));
  EXPECT_THAT(fault(Datagram().add(kGap, gap(0, 8))), HasSubstr("GAP"));
}

TEST(DatagramCheck, RefusesAPayloadThatIsNotWhereItIsSaidToBe) {
  for (const std::uint16_t offset : {0, 12, 17, 60, 0x7ff0, 0xfff0}) {
    EXPECT_THAT(fault(Datagram().add(kData, data(1, offset).zeros(8), kHasData)), HasSubstr("DATA"))
        << offset;
  }
  EXPECT_THAT(fault(Datagram().add(kData, data(1, 20).zeros(8), kHasData)), IsEmpty());
  EXPECT_THAT(fault(Datagram().add(kData, data(), kHasData)), HasSubstr("empty"));
  EXPECT_THAT(fault(Datagram().add(kData, data().zeros(8), kHasData | kHasKey)), HasSubstr("both"));
  const Body nobody = Body().u16(0).u16(16).entity(0).entity(0).sequence_number(1).zeros(8);
  EXPECT_THAT(fault(Datagram().add(kData, nobody, kHasData)), HasSubstr("DATA"));
}

TEST(DatagramCheck, RefusesInlineQosThatDoesNotEndInItsSubmessage) {
  const Body key = Body().parameter(0x70, Body().zeros(16));
  const Body end = Body().u16(1).u16(0);
  const auto with = [](const Body& qos) {
    return fault(Datagram().add(kData, data().append(qos).zeros(8), kHasData | kInlineQos));
  };
  EXPECT_THAT(with(Body(key).append(end)), IsEmpty());
  EXPECT_THAT(with(key), HasSubstr("DATA"));  // no end
  EXPECT_THAT(with(Body().parameter(0x70, Body().zeros(12)).append(end)), HasSubstr("DATA"));
  EXPECT_THAT(with(Body().u16(0x7000).u16(400).append(end)), HasSubstr("DATA"));  // too long
  EXPECT_THAT(with(Body().parameter(0x7000, Body().zeros(6)).append(end)), HasSubstr("DATA"));
}

TEST(DatagramCheck, RefusesFragmentsThatTheirMessageDoesNotHave) {
  const auto with = [](const Fragment& f) { return fault(Datagram().add(kDataFrag, fragment(f))); };
  EXPECT_THAT(with({.first = 4}), IsEmpty());
  EXPECT_THAT(with({.first = 0}), HasSubstr("numbers fragments"));
  EXPECT_THAT(with({.first = 5}), HasSubstr("numbers fragments"));
  EXPECT_THAT(with({.first = 3, .count = 3, .payload = 3072}), HasSubstr("numbers fragments"));
  EXPECT_THAT(with({.count = 0}), HasSubstr("numbers fragments"));
  EXPECT_THAT(with({.count = 2, .payload = 2044}), HasSubstr("lacks bytes"));
  EXPECT_THAT(with({.size = 0}), HasSubstr("sizes"));
  EXPECT_THAT(with({.size = 2}), HasSubstr("sizes"));
  EXPECT_THAT(with({.size = 1025, .payload = 1028}), HasSubstr("sizes"));
  EXPECT_THAT(with({.whole = 0}), HasSubstr("sizes"));
  EXPECT_THAT(with({.whole = wire::kMostSample + 1}), HasSubstr("too large"));
  EXPECT_THAT(with({.size = 4, .whole = wire::kMostSample}), HasSubstr("too many"));
}

TEST(DatagramCheck, RefusesRequestsForFragmentsThatCannotBe) {
  const auto with = [](std::uint32_t base, std::uint32_t bits) {
    return fault(Datagram().add(
        kNackFrag,
        ends().sequence_number(1).u32(base).u32(bits).zeros((bits + 31) / 32 * 4).u32(1)));
  };
  EXPECT_THAT(with(1, 256), IsEmpty());
  EXPECT_THAT(with(0, 8), HasSubstr("NACK_FRAG"));
  EXPECT_THAT(with(1, 257), HasSubstr("NACK_FRAG"));
  EXPECT_THAT(with(0xffffff80, 256), HasSubstr("NACK_FRAG"));
}

TEST(DatagramCheck, RefusesAnotherSenderThanTheHeadersOwn) {
  EXPECT_THAT(fault(Datagram().add(kInfoSource, Body().zeros(19).u8(7))), IsEmpty());
  EXPECT_THAT(fault(Datagram().add(kInfoSource, Body().zeros(19).u8(8))),
              HasSubstr("another sender"));
  EXPECT_THAT(fault(Datagram().add(kInfoSource, Body().zeros(19).u8(7).zeros(4))),
              HasSubstr("INFO_SRC"));
}

TEST(DatagramCheck, RefusesEncryptedPartsThatClaimMoreThanTheyAre) {
  const Body prefix = Body().zeros(20);
  const auto big = [](std::uint32_t v) {
    return Body()
        .u8(std::uint8_t(v >> 24))
        .u8(std::uint8_t(v >> 16))
        .u8(std::uint8_t(v >> 8))
        .u8(std::uint8_t(v));
  };
  const auto with = [&](std::uint32_t body, std::uint32_t readers) {
    return fault(Datagram()
                     .add(0x33, prefix)
                     .add(0x30, big(body).zeros(32))
                     .add(0x34, Body().zeros(16).append(big(readers)).zeros(20)));
  };
  EXPECT_THAT(with(32, 1), IsEmpty());
  EXPECT_THAT(with(33, 1), HasSubstr("encrypted"));
  EXPECT_THAT(with(0xffffffff, 1), HasSubstr("encrypted"));
  EXPECT_THAT(with(32, 2), HasSubstr("signature"));
  EXPECT_THAT(fault(Datagram().add(0x31, Body().zeros(16))), HasSubstr("security header"));
}

}  // namespace
}  // namespace goshawk::runtime
