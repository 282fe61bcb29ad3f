// The lives of one map server: what each begins with, and under which versions.
#include "beginning.hpp"

#include <gmock/gmock.h>

#include "scan_support.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kNow_ns = 1'700'000'000'000'000'000;
const std::vector<Vec3> kWall{Vec3(3.1, 2.1, 1.1), Vec3(3.1, 2.3, 1.1)};
const Vec3 kFrom(1.1, 2.1, 1.1);

class Lives : public ::testing::Test {
 protected:
  Lives() {
    config_.use_box = true;
    config_.unknown = UnknownPolicy::free;
    config_.journal_file = folder_.file("map.journal");
  }

  /// A life: sees the same wall again and again, and dies. @return the newest version published
  std::uint64_t live(int scans, std::int64_t now_ns = kNow_ns) {
    auto beginning = begin_map(config_, now_ns);
    EXPECT_TRUE(beginning) << beginning.error().message;
    EXPECT_GT(beginning->map.version() + beginning->versions_before, newest_)
        << "a version is used twice";
    fault_ = beginning->journal_fault;
    for (int k = 0; k < scans; ++k) {
      const auto result = testing::insert(beginning->map, kWall, kFrom, 10.0).value();
      if (!beginning->journal) continue;
      beginning->journal->add(result.update.to_version + beginning->versions_before,
                              journal_bricks(result.update, beginning->map.geometry()));
    }
    grid_ = beginning->map.grid();
    bricks_ = beginning->bricks;
    newest_ = beginning->map.version() + beginning->versions_before;
    return newest_;
  }

  testing::Folder folder_;
  Config config_;
  std::optional<Error> fault_;
  VoxelGrid grid_;
  std::size_t bricks_ = 0;
  std::uint64_t newest_ = 0;
};

TEST_F(Lives, TheFirstBeginsWithVersion1) {
  EXPECT_EQ(live(0), 1U);
}

TEST_F(Lives, NoneUsesAVersionAgainThoughNothingChangesAndTheClockStands) {
  live(3000);
  const VoxelGrid grid = grid_;
  for (int life = 0; life < 4; ++life) {
    live(3000);
    EXPECT_FALSE(fault_);
    EXPECT_GT(bricks_, 0U);
    EXPECT_EQ(grid_.raw, grid.raw);
    EXPECT_EQ(grid_.known, grid.known);
  }
  live(10, kNow_ns - 3'600'000'000'000);  // the clock was set back
  live(10, 0);
}

TEST_F(Lives, AfterALifeThatWroteNoBatchVersionsGoOnByTheClock) {
  live(0);
  live(5, kNow_ns);
  EXPECT_GE(newest_, std::uint64_t(kNow_ns / 1'000'000));
}

TEST_F(Lives, WithAJournalThatIsRefusedVersionsGoOnByTheClock) {
  live(20);
  folder_.write("map.journal", "a letter, which must not be lost, and no journal of a map");
  live(20);
  ASSERT_TRUE(fault_);
  EXPECT_EQ(fault_->code, ErrorCode::map_malformed);
  EXPECT_THAT(fault_->message, HasSubstr("map.journal.refused"));
  EXPECT_EQ(bricks_, 0U);
  live(20, kNow_ns + 60'000'000'000);
  EXPECT_GT(bricks_, 0U);
}

TEST_F(Lives, WithoutAPlaceForTheJournalVersionsGoOnByTheClock) {
  config_.journal_file = folder_.file("absent/map.journal");
  live(20, kNow_ns);
  ASSERT_TRUE(fault_);
  EXPECT_EQ(fault_->code, ErrorCode::io_failed);
  live(20, kNow_ns + 1'000'000'000);
}

TEST_F(Lives, OfAMapFileThatFollowsKeepWhatLiesOutsideOfTheWindow) {
  config_.map_file = folder_.write("m.3dmap", "voxel 400 40 20\n0 0 0\n390 20 10\n");
  config_.box_x_max_m = 12.8;
  config_.follow_vehicle = true;
  live(20);
  const auto again = begin_map(config_, kNow_ns);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_GT(again->bricks, 0U);
  EXPECT_EQ(again->map.bricks_kept(), 6 * 5 * 3);  // of 7 x 5 x 3 bricks all but the window's
  const VoxelGrid grid = again->map.grid();
  EXPECT_TRUE(grid.raw.get(*grid.geometry.index_of(kWall[0])));
  EXPECT_TRUE(grid.raw.get({0, 0, 0}));
}

TEST_F(Lives, WithADamagedJournalTellsWhatIsLeftOut) {
  live(20);
  std::string bytes = testing::bytes_of(config_.journal_file);
  bytes[bytes.size() - 100] ^= 1;
  folder_.write("map.journal", bytes);
  live(0);
  ASSERT_TRUE(fault_);
  EXPECT_EQ(fault_->code, ErrorCode::map_malformed);
  EXPECT_THAT(fault_->message, HasSubstr("damaged or cut off"));
}

}  // namespace
}  // namespace goshawk::map_server
