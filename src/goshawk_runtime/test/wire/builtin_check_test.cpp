#include <gmock/gmock.h>

#include "../../src/wire/datagram_check.hpp"
#include "datagram.hpp"

namespace goshawk::runtime {
namespace {

using namespace runtime_test;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint32_t kParticipants = 0x000100c2, kPublications = 0x000003c2,
                        kLiveliness = 0x000200c2, kHandshake = 0x000201c3;

Body encapsulation(std::uint8_t kind) {
  return Body().u8(0).u8(kind).u16(0);
}
Body end() {
  return Body().u16(1).u16(0);
}

std::string fault_of_sample(std::uint32_t writer, const Body& payload, std::uint32_t reader = 0) {
  const Body data =
      Body().u16(0).u16(16).entity(reader).entity(writer).sequence_number(1).append(payload);
  return std::string(wire::fault_of(Datagram().add(kData, data, kHasData).bytes()));
}
std::string fault_of_parameter(std::uint16_t id, const Body& value) {
  return fault_of_sample(kPublications, encapsulation(3).parameter(id, value).append(end()));
}

TEST(BuiltinCheck, AdmitsDiscoveryOfAnyVendor) {
  const Body all = encapsulation(3)
                       .parameter(0x0005, Body().text("rt/path"))
                       .parameter(0x0029, Body().u32(2).text("a").text("bcde"))
                       .parameter(0x0059, Body().u32(1).text("PID").text("12345"))
                       .parameter(0x002c, Body().u32(3).u8(1).u8(2).u8(3).u8(0))
                       .parameter(0x0073, Body().u32(1).u16(0).u16(0))
                       .parameter(0x1001, Body().text("PKI").u32(1).text("a").text("b").u32(0))
                       .parameter(0x8006, Body().u32(1).zeros(8))
                       .parameter(0xbeef, Body().zeros(40))
                       .append(end());
  EXPECT_THAT(fault_of_sample(kPublications, all), IsEmpty());
  EXPECT_THAT(fault_of_sample(kParticipants, all), IsEmpty());
}

TEST(BuiltinCheck, RefusesCountsThatTheParameterDoesNotHold) {
  const Body many = Body().u32(0xffffffff).zeros(60);
  for (const std::uint16_t id : {0x0005, 0x0007, 0x0029, 0x002c, 0x002d, 0x002e, 0x0059, 0x0062,
                                 0x0073, 0x1001, 0x1002, 0x8006}) {
    EXPECT_THAT(fault_of_parameter(id, many), HasSubstr("discovery")) << id;
  }
  EXPECT_THAT(fault_of_parameter(0x1001, Body().text("PKI").u32(0).u32(1).text("key").u32(9'000)),
              HasSubstr("discovery"));
}

TEST(BuiltinCheck, RefusesAListWithoutEndOrWithALengthThatLeavesIt) {
  EXPECT_THAT(fault_of_sample(kParticipants, encapsulation(3)), HasSubstr("discovery"));
  EXPECT_THAT(fault_of_sample(kParticipants, encapsulation(3).u16(5).u16(64).text("rt/path")),
              HasSubstr("discovery"));
  EXPECT_THAT(fault_of_sample(kParticipants, Body().u8(0).u8(3)), HasSubstr("discovery"));
  EXPECT_THAT(fault_of_sample(kParticipants, encapsulation(1).append(end())),
              HasSubstr("discovery"));
}

TEST(BuiltinCheck, ReadsBigEndianLists) {
  const Body big = encapsulation(2).u16(0x0500).u16(0x0800).u8(0).u8(0).u8(0).u8(4).u32(0);
  EXPECT_THAT(fault_of_sample(kParticipants, Body(big).u16(0x0100).u16(0)), IsEmpty());
}

// Only one end is of a built-in topic: Fast DDS may still read the sample as of that topic.
TEST(BuiltinCheck, ChecksForEitherEnd) {
  const Body no_list = Body().zeros(32);
  EXPECT_THAT(fault_of_sample(0x00000103, no_list), IsEmpty());
  EXPECT_THAT(fault_of_sample(0x00000103, no_list, 0x000100c7), HasSubstr("discovery"));
  EXPECT_THAT(fault_of_sample(kParticipants, no_list, 0x00000104), HasSubstr("discovery"));
}

TEST(BuiltinCheck, RefusesSignsOfLifeThatAreCutOff) {
  const Body alive = encapsulation(1).zeros(12).u32(1).u32(1).u32(0);
  EXPECT_THAT(fault_of_sample(kLiveliness, alive), IsEmpty());
  EXPECT_THAT(fault_of_sample(kLiveliness, encapsulation(1).zeros(12)), HasSubstr("discovery"));
  EXPECT_THAT(fault_of_sample(kLiveliness, encapsulation(1).zeros(16).u32(900)),
              HasSubstr("discovery"));
}

TEST(BuiltinCheck, RefusesHandshakesThatClaimMoreThanTheyBring) {
  const Body begin = encapsulation(1).zeros(96).text("dds.sec.auth");
  const Body holder = Body().text("DDS:Auth").u32(0).u32(1).text("c.id").u32(4).u32(0xab);
  EXPECT_THAT(fault_of_sample(kHandshake, Body(begin).u32(1).append(holder)), IsEmpty());
  EXPECT_THAT(fault_of_sample(kHandshake, Body(begin).u32(0x00ffffff).append(holder)),
              HasSubstr("discovery"));
  EXPECT_THAT(fault_of_sample(kHandshake, Body().zeros(40)), HasSubstr("discovery"));
}

TEST(BuiltinCheck, RefusesDiscoveryInFragments) {
  const Body fragment = Body()
                            .u16(0)
                            .u16(28)
                            .entity(0)
                            .entity(kPublications)
                            .sequence_number(1)
                            .u32(1)
                            .u16(1)
                            .u16(8)
                            .u32(16)
                            .zeros(8);
  EXPECT_THAT(std::string(wire::fault_of(Datagram().add(kDataFrag, fragment).bytes())),
              HasSubstr("in fragments"));
}

}  // namespace
}  // namespace goshawk::runtime
