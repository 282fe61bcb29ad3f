#include "goshawk/stage/background_map.hpp"

#include <gtest/gtest.h>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/grid.hpp"
#include "two_nodes.hpp"

namespace goshawk::stage {
namespace {

using goshawk_msgs::msg::VoxelGridUpdate;
using MapMessage = goshawk_msgs::msg::VoxelGrid;

VoxelGrid small_grid(std::uint64_t version) {
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.2, {70, 20, 10}};
  grid.grown = BitGrid(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false, true);
  grid.version = version;
  return grid;
}

/// A node whose thread is kept busy by the test: only the map's own thread runs.
class InBackground : public testing::Test {
 protected:
  /// @param done asked until it is true, and not again. @return whether it was
  template <typename Done>
  bool wait(const Done& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < end) {
      if (done()) return true;
      nodes_.other.spin_some(0.01);
    }
    return false;
  }
  void publish(const VoxelGrid& grid) {
    MapMessage m;
    conversions::fill_msg(grid, m);
    m.header(conversions::make_header(1));
    EXPECT_TRUE(whole_.publish(m));
  }
  std::shared_ptr<const VoxelGrid> next() {
    std::shared_ptr<const VoxelGrid> grid;
    wait([&] { return (grid = map_.take()) != nullptr; });
    return grid;
  }

  stage_test::TwoNodes nodes_;
  runtime::Publisher<MapMessage> whole_ =
      nodes_.other.advertise<MapMessage>("map/voxels", runtime::Qos::latched());
  runtime::Publisher<VoxelGridUpdate> updates_ = nodes_.other.advertise<VoxelGridUpdate>(
      "map/voxels/updates", runtime::Qos::reliable_last(50));
  BackgroundMap map_{nodes_.stage};
};

TEST_F(InBackground, MapsAndUpdatesComeWhileTheNodeDoesSomethingElse) {
  EXPECT_EQ(map_.take(), nullptr);
  publish(small_grid(1));
  const auto first = next();
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->version, 1U);
  EXPECT_EQ(map_.take(), nullptr) << "each once";

  GridUpdate update{1, 2, {}, {}};
  Brick brick;
  brick.grown[0] = 4;  // x = 2
  update.bricks.push_back(brick);
  VoxelGridUpdate m;
  conversions::fill_msg(update, m);
  m.header(conversions::make_header(1));
  ASSERT_TRUE(wait([&] { return updates_.matched() > 0; }));
  ASSERT_TRUE(updates_.publish(m));
  const auto second = next();
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(second->version, 2U);
  EXPECT_TRUE(second->grown.test({2, 0, 0}));
  EXPECT_FALSE(first->grown.test({2, 0, 0})) << "a map that was handed out does not change";
}

TEST_F(InBackground, OfMapsThatNobodyTookTheNewestIsHandedOver) {
  for (std::uint64_t version = 1; version <= 5; ++version) publish(small_grid(version));
  std::uint64_t seen = 0;
  ASSERT_TRUE(wait([&] {
    if (const auto grid = map_.take()) {
      EXPECT_GT(grid->version, seen);
      seen = grid->version;
    }
    return seen == 5;
  }));
}

TEST_F(InBackground, AMapIsFreedByTheMapsThreadAndNotByTheOneThatTakes) {
  publish(small_grid(1));
  std::weak_ptr<const VoxelGrid> first = next();
  ASSERT_FALSE(first.expired());
  publish(small_grid(2));
  ASSERT_NE(next(), nullptr);
  EXPECT_FALSE(first.expired()) << "until the map's thread is there again";
  publish(small_grid(3));
  EXPECT_TRUE(wait([&] { return first.expired(); }));
}

TEST_F(InBackground, AFaultIsHandedOverAndTheMapBeforeItStays) {
  publish(small_grid(1));
  ASSERT_NE(next(), nullptr);
  EXPECT_FALSE(map_.take_fault());
  MapMessage m;
  conversions::fill_msg(small_grid(2), m);
  m.header(conversions::make_header(1));
  m.grown().pop_back();
  ASSERT_TRUE(whole_.publish(m));
  std::optional<Error> fault;
  ASSERT_TRUE(wait([&] { return (fault = map_.take_fault()).has_value(); }));
  EXPECT_EQ(fault->code, ErrorCode::invalid_input);
  EXPECT_EQ(map_.take(), nullptr);
}

}  // namespace
}  // namespace goshawk::stage
