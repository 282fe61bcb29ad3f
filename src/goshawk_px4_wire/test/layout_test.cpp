#include "goshawk/px4_wire/layout.hpp"

#include <gtest/gtest.h>

#include "goshawk/px4_wire/definitions.hpp"

namespace goshawk::px4 {
namespace {

TEST(Layout, PutsEachNumberAtAMultipleOfItsSize) {
  const Layout layout("uint8 a; float64 b; bool c; uint16 d; float32[3] e; int8 f");
  EXPECT_EQ(layout.find("a")->offset, 0u);
  EXPECT_EQ(layout.find("b")->offset, 8u);
  EXPECT_EQ(layout.find("c")->offset, 16u);
  EXPECT_EQ(layout.find("d")->offset, 18u);
  EXPECT_EQ(layout.find("e")->offset, 20u);
  EXPECT_EQ(layout.find("e")->count, 3u);
  EXPECT_EQ(layout.find("f")->offset, 32u);
  EXPECT_EQ(layout.size(), 33u);
  EXPECT_EQ(layout.find("g"), nullptr);
}

// Sizes seen on the wire.
TEST(Layout, HasTheSizesThatPx4Sends) {
  const auto size = [](std::string_view type, Release release) {
    return definition_of(type, release).layout.size();
  };
  EXPECT_EQ(size("VehicleOdometry", Release::v1_17), 114u);
  EXPECT_EQ(size("VehicleLocalPosition", Release::v1_17), 216u);
}

TEST(Layout, FiveEventsLieOneAfterAnother) {
  const Layout layout("uint64 timestamp; uint8 n; Event[5] events; bool last");
  // 8, 1, then from 16: 8 + 4 + 2 + 25 + 1 = 40 bytes each.
  EXPECT_EQ(layout.find("last")->offset, 16u + 5u * 40u);
}

TEST(Layout, RefusesWhatIsNoDefinition) {
  EXPECT_THROW(Layout("uint8"), std::logic_error);
  EXPECT_THROW(Layout("int9 a"), std::logic_error);
  EXPECT_THROW(Layout("uint8[x] a"), std::logic_error);
  EXPECT_THROW(Layout("uint8[0] a"), std::logic_error);
  EXPECT_THROW(Layout("uint8 a; uint8 a"), std::logic_error);
}

}  // namespace
}  // namespace goshawk::px4
