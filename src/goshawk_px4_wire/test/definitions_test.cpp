#include "goshawk/px4_wire/definitions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace goshawk::px4 {
namespace {

constexpr std::array kReleases{Release::v1_15, Release::v1_16, Release::v1_17, Release::v1_18};

struct Known {
  std::string_view type;
  std::array<std::uint32_t, 4> hashes;  // of 1.15 to 1.18; 0: no such message
};
// Computed by another program from the message files of PX4/px4_msgs, release by release.
constexpr auto kKnown = std::to_array<Known>({
    {"VehicleOdometry", {0x3af07476, 0x3af07476, 0x3af07476, 0x3af07476}},
    {"VehicleLocalPosition", {0x2be8bcb6, 0x5141d2f7, 0x5141d2f7, 0x5141d2f7}},
    {"VehicleStatus", {0xa492864e, 0xf779fa65, 0xf779fa65, 0x53ee3679}},
    {"VehicleLandDetected", {0x4c30e23f, 0x4c30e23f, 0x4c30e23f, 0x4c30e23f}},
    {"BatteryStatus", {0xe2fc0296, 0x308ded9f, 0xfd330964, 0xfd330964}},
    {"FailsafeFlags", {0xd9bc4415, 0x3a4929c3, 0x69e039f7, 0xbc6bf28c}},
    {"ManualControlSetpoint", {0x22fe7136, 0x22fe7136, 0x22fe7136, 0x22fe7136}},
    {"VehicleCommandAck", {0xa47749fe, 0xa47749fe, 0xa47749fe, 0xa47749fe}},
    {"RegisterExtComponentReply", {0x3f5a272f, 0x3f5a272f, 0x3f5a272f, 0x4a5465b5}},
    {"ArmingCheckRequest", {0x7b7b8dae, 0x7b7b8dae, 0x6e29cdcd, 0x6e29cdcd}},
    {"MessageFormatResponse", {0x60a08c2d, 0x60a08c2d, 0x60a08c2d, 0x60a08c2d}},
    {"SetpointConfigReply", {0, 0, 0, 0xc7b4f2f4}},
    {"VehicleCommand", {0xcba514af, 0xcba514af, 0xcba514af, 0xcba514af}},
    {"OffboardControlMode", {0x2ff32960, 0x2ff32960, 0x2ff32960, 0x2ff32960}},
    {"TrajectorySetpoint", {0xf614acde, 0xf614acde, 0xf614acde, 0xf614acde}},
    {"VehicleAttitudeSetpoint", {0x8fe976cb, 0x2032c575, 0x0591bb5a, 0x0591bb5a}},
    {"VehicleControlMode", {0x25a90612, 0x25a90612, 0x25a90612, 0x1f4c4a57}},
    {"SetpointConfig", {0, 0, 0, 0x7e529496}},
    {"RegisterExtComponentRequest", {0x35cde621, 0x35cde621, 0x35cde621, 0x28168dd6}},
    {"UnregisterExtComponent", {0x58239ba9, 0x58239ba9, 0x58239ba9, 0x58239ba9}},
    {"ArmingCheckReply", {0x03ea8a66, 0x03ea8a66, 0x7c350de4, 0x7c350de4}},
    {"MessageFormatRequest", {0x24e20cb7, 0x24e20cb7, 0x24e20cb7, 0x24e20cb7}},
});

TEST(Definitions, HaveTheHashesOfPx4) {
  for (const auto& [type, hashes] : kKnown) {
    for (std::size_t i = 0; i < kReleases.size(); ++i) {
      const auto found = find_definition(type, kReleases[i]);
      ASSERT_EQ(found.has_value(), hashes[i] != 0) << type << " " << to_word(kReleases[i]);
      if (!found) continue;
      EXPECT_EQ(found->layout.hash(), hashes[i]) << type << " " << to_word(kReleases[i]);
    }
  }
}

TEST(Definitions, NameTopicsAsEachReleaseDoes) {
  const auto name = [](std::string_view topic, std::string_view type, Release release) {
    return topic_of(topic, definition_of(type, release));
  };
  EXPECT_EQ(name("out/vehicle_status", "VehicleStatus", Release::v1_15), "fmu/out/vehicle_status");
  EXPECT_EQ(name("out/vehicle_status", "VehicleStatus", Release::v1_17),
            "fmu/out/vehicle_status_v1");
  EXPECT_EQ(name("out/vehicle_status", "VehicleStatus", Release::v1_18),
            "fmu/out/vehicle_status_v4");
  EXPECT_EQ(name("out/vehicle_local_position", "VehicleLocalPosition", Release::v1_16),
            "fmu/out/vehicle_local_position");
  EXPECT_EQ(wire_type_of("VehicleStatus"), "px4_msgs::msg::dds_::VehicleStatus_");
}

TEST(Definitions, AHashTellsWhichReleasesHaveThatLayout) {
  EXPECT_EQ(releases_with("VehicleStatus", 0xf779fa65),
            (std::vector{Release::v1_16, Release::v1_17}));
  EXPECT_TRUE(releases_with("VehicleStatus", 0x12345678).empty());
}

TEST(Definitions, AMessageThatAReleaseDoesNotHaveIsABug) {
  EXPECT_FALSE(find_definition("SetpointConfig", Release::v1_17));
  EXPECT_THROW(definition_of("SetpointConfig", Release::v1_17), std::logic_error);
}

}  // namespace
}  // namespace goshawk::px4
