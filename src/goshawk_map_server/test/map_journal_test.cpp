#include "goshawk/map_server/map_journal.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "goshawk/map_server/live_map.hpp"
#include "journal_format.hpp"
#include "scan_support.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

using ::testing::HasSubstr;

constexpr JournalIdentity kIdentity{0.2, 77};

JournalBrick random_brick(Random& random, int places) {
  JournalBrick brick;
  brick.corner = {64 * int(random.uniform(-places, places)), 8 * int(random.uniform(-places, places)),
                  8 * int(random.uniform(-places, places))};
  for (auto& word : brick.raw) word = random.next();
  for (auto& word : brick.known) word = random.next();
  return brick;
}

/// Batches, and what they come to, kept in a way of its own.
struct Truth {
  std::vector<std::vector<JournalBrick>> batches;

  std::map<Index3, JournalBrick, JournalOrder> after(std::size_t count) const {
    std::map<Index3, JournalBrick, JournalOrder> bricks;
    for (std::size_t k = 0; k < count; ++k) {
      for (const JournalBrick& brick : batches[k]) bricks[brick.corner] = brick;
    }
    return bricks;
  }
};

Truth random_batches(Random& random, int count, int places) {
  Truth truth;
  for (int k = 0; k < count; ++k) {
    std::map<Index3, JournalBrick, JournalOrder> batch;  // each brick once
    for (int b = 0; b < 1 + k % 5; ++b) {
      const JournalBrick brick = random_brick(random, places);
      batch[brick.corner] = brick;
    }
    truth.batches.emplace_back();
    for (const auto& [corner, brick] : batch) truth.batches.back().push_back(brick);
  }
  return truth;
}

void write_batches(MapJournal& journal, const Truth& truth) {
  for (std::size_t k = 0; k < truth.batches.size(); ++k) {
    const Status status = journal.append(k + 1, truth.batches[k]);
    ASSERT_TRUE(status) << status.error().message;
  }
}

JournalContent read_whole(const std::string& bytes) {
  return read_journal(std::as_bytes(std::span(bytes)), kIdentity).value();
}

class Journal : public ::testing::Test {
 protected:
  map_server::testing::Folder folder_;
  std::string path_ = folder_.file("map.journal");
  Random random_{9};
};

TEST_F(Journal, GivesBackTheNewestOfEachBrick) {
  const Truth truth = random_batches(random_, 60, 3);
  {
    MapJournal journal = MapJournal::open(path_, kIdentity).value();
    EXPECT_TRUE(journal.content().bricks.empty());
    write_batches(journal, truth);
  }
  const MapJournal again = MapJournal::open(path_, kIdentity).value();
  EXPECT_EQ(again.content().bricks, truth.after(60));
  EXPECT_EQ(again.content().version, 60U);
  EXPECT_EQ(again.content().damaged, 0);
}

TEST_F(Journal, GoesOnWhereItEnded) {
  const Truth truth = random_batches(random_, 20, 2);
  for (std::size_t k = 0; k < truth.batches.size(); ++k) {
    MapJournal journal = MapJournal::open(path_, kIdentity).value();
    ASSERT_EQ(journal.content().bricks, truth.after(k));
    ASSERT_TRUE(journal.append(k + 1, truth.batches[k]));
  }
}

// A process may be killed, or a machine may stop, at any byte.
TEST_F(Journal, CutOffAnywhereItHoldsTheBatchesThatAreWhole) {
  const Truth truth = random_batches(random_, 12, 2);
  MapJournal journal = MapJournal::create(path_, kIdentity).value();
  write_batches(journal, truth);
  const std::string whole = map_server::testing::bytes_of(path_);
  std::vector<std::size_t> ends{sizeof(JournalHead)};
  for (const auto& batch : truth.batches) {
    ends.push_back(ends.back() + batch.size() * sizeof(JournalEntry));
  }
  ASSERT_EQ(ends.back(), whole.size());
  for (std::size_t length = sizeof(JournalHead); length <= whole.size(); length += 97) {
    const JournalContent content = read_whole(whole.substr(0, length));
    const auto batches =
        std::size_t(std::ranges::upper_bound(ends, length) - ends.begin()) - 1;
    ASSERT_EQ(content.bricks, truth.after(batches)) << length;
    ASSERT_EQ(content.version, batches) << length;
    ASSERT_EQ(content.damaged > 0, length != ends[batches]) << length;
    ASSERT_EQ(content.whole_bytes, ends[batches]);
  }
}

// A batch is one version of the map: with a damaged entry nothing of it counts, all others do.
TEST_F(Journal, DamageIsNoticedAndTakesItsOwnBatchOnly) {
  const Truth truth = random_batches(random_, 12, 50);  // no brick comes twice
  MapJournal journal = MapJournal::create(path_, kIdentity).value();
  write_batches(journal, truth);
  const std::string whole = map_server::testing::bytes_of(path_);
  std::vector<std::size_t> owner;  // the batch of each entry
  for (std::size_t k = 0; k < truth.batches.size(); ++k) {
    owner.insert(owner.end(), truth.batches[k].size(), k);
  }
  for (std::size_t at = sizeof(JournalHead); at < whole.size(); at += 501) {
    std::string damaged = whole;
    damaged[at] = char(damaged[at] ^ 4);
    const std::size_t hit = owner[(at - sizeof(JournalHead)) / sizeof(JournalEntry)];
    auto expected = truth.after(12);
    for (const JournalBrick& brick : truth.batches[hit]) expected.erase(brick.corner);
    const JournalContent content = read_whole(damaged);
    ASSERT_EQ(content.bricks, expected) << at;
    ASSERT_EQ(content.damaged, std::int64_t(truth.batches[hit].size())) << at;
  }
}

TEST_F(Journal, OfAnotherMapOrOtherFilesAreRefusedAndStayAsTheyAre) {
  ASSERT_TRUE(MapJournal::create(path_, {0.2, 78}));
  const auto other = MapJournal::open(path_, kIdentity);
  EXPECT_EQ(other.code(), ErrorCode::invalid_input);
  EXPECT_THAT(other.error().message, HasSubstr("another map"));
  const std::string text = folder_.write("letter.txt", "Dear reader, this is a letter and no map.");
  EXPECT_EQ(MapJournal::open(text, kIdentity).code(), ErrorCode::map_malformed);
  EXPECT_THAT(map_server::testing::bytes_of(text), HasSubstr("Dear reader"));
}

TEST_F(Journal, IsWrittenAnewWhenMostOfItIsObsolete) {
  MapJournal journal = MapJournal::create(path_, kIdentity).value();
  const Truth truth = random_batches(random_, 3, 2);
  std::map<Index3, JournalBrick, JournalOrder> newest;
  std::uintmax_t largest = 0;
  std::uint64_t version = 0;
  while (version < 40'000) {  // 120 MB, if nothing were given up
    std::vector<JournalBrick> batch = truth.batches[version % 3];
    for (JournalBrick& brick : batch) {
      brick.raw[0] = version;
      newest[brick.corner] = brick;
    }
    ASSERT_TRUE(journal.append(++version, batch));
    if (version % 500 == 0) largest = std::max(largest, std::filesystem::file_size(path_));
  }
  EXPECT_LT(largest, 20U << 20);
  const MapJournal again = MapJournal::open(path_, kIdentity).value();
  EXPECT_EQ(again.content().bricks, newest);
  EXPECT_EQ(again.content().version, version);
}

TEST_F(Journal, ThatCannotBeWrittenAnewGoesOnAndTriesAgainWhenItHasGrown) {
  MapJournal journal = MapJournal::create(path_, kIdentity).value();
  const std::string in_the_way = path_ + ".part";
  std::filesystem::create_directory(in_the_way);
  std::vector<JournalBrick> batch(8, random_brick(random_, 1));
  for (std::size_t k = 0; k < batch.size(); ++k) batch[k].corner = {64 * int(k), 0, 0};
  std::uint64_t version = 0;
  const auto write_until = [&](std::uintmax_t bytes) {
    do {
      batch[0].raw[0] = ++version;
      ASSERT_TRUE(journal.append(version, batch));
    } while (std::filesystem::file_size(path_) < bytes);
  };
  write_until(MapJournal::kSmall_bytes + (1U << 20));
  ASSERT_EQ(read_whole(map_server::testing::bytes_of(path_)).version, version);
  std::filesystem::remove(in_the_way);
  write_until(2 * MapJournal::kSmall_bytes - (1U << 20));  // not yet
  for (int k = 0; k < 400; ++k) {
    batch[0].raw[0] = ++version;
    ASSERT_TRUE(journal.append(version, batch));
  }
  EXPECT_LT(std::filesystem::file_size(path_), MapJournal::kSmall_bytes);
  const JournalContent content = read_whole(map_server::testing::bytes_of(path_));
  EXPECT_EQ(content.version, version);
  EXPECT_EQ(content.bricks.at(batch[0].corner), batch[0]);
  EXPECT_EQ(content.damaged, 0);
}

TEST_F(Journal, ADiskThatIsFullIsToldAndNothingThatIsWholeIsLost) {
  // Every write to this device fails as on a full disk.
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const auto full = MapJournal::create("/dev/full", kIdentity);
  EXPECT_EQ(full.code(), ErrorCode::io_failed);
  EXPECT_THAT(full.error().message, HasSubstr("No space left on device"));
  EXPECT_EQ(MapJournal::open(folder_.file("absent/map.journal"), kIdentity).code(),
            ErrorCode::io_failed);
}

TEST_F(Journal, OfALiveMapGivesTheMapBack) {
  const Growth growth{UnknownPolicy::free, 0.25};
  const Box box{Vec3(-7.4, -2.0, -1.0), Vec3(8.0, 2.2, 1.4)};
  LiveMap map = LiveMap::unknown_space(box, 0.2, growth).value();
  MapJournal journal = MapJournal::create(path_, kIdentity).value();
  RawVoxels voxels{map.geometry(), map.grid().raw, map.grid().known};
  for (int scan = 0; scan < 20; ++scan) {
    const Vec3 from(random_.uniform(-3, 3), random_.uniform(-1, 1), 0.1);
    std::vector<Vec3> points;
    for (int k = 0; k < 60; ++k) {
      points.push_back(from + 4.0 * Vec3(random_.uniform(-1, 1), random_.uniform(-1, 1),
                                         random_.uniform(-0.3, 0.3)));
    }
    const auto result = testing::insert(map, points, from, 4.0);
    ASSERT_TRUE(result);
    ASSERT_TRUE(journal.append(result->update.to_version,
                               journal_bricks(result->update, map.geometry())));
  }
  MapJournal::open(path_, kIdentity).value().content().write_into(voxels);
  EXPECT_EQ(voxels.occupied, map.grid().raw);
  EXPECT_EQ(voxels.known, map.grid().known);
  EXPECT_GT(voxels.known.count(), 1000);
  MapSource source;
  source.voxels = voxels;
  const LiveMap restored = LiveMap::from_source(source, {}, growth).value();
  EXPECT_EQ(restored.grid().grown, map.grid().grown);
}

TEST_F(Journal, ABrickThatNoMapReachesIsDamage) {
  JournalBrick brick = random_brick(random_, 1);
  brick.corner.y = 1 << 30;
  MapJournal journal = MapJournal::create(path_, kIdentity).value();
  ASSERT_TRUE(journal.append(1, {&brick, 1}));
  const JournalContent content = read_whole(map_server::testing::bytes_of(path_));
  EXPECT_TRUE(content.bricks.empty());
  EXPECT_EQ(content.damaged, 1);
}

// A window that moves leaves behind what the journal keeps.
TEST_F(Journal, OfAMapThatFollowsCoversAllBricks) {
  const GridGeometry geometry{Vec3(-0.4, 1.2, 0.0), 0.2, {70, 20, 12}};
  RawVoxels window{geometry, BitGrid(geometry.size, true), BitGrid(geometry.size, false)};
  window.known.set({3, 4, 5}, true);
  window.occupied.set({3, 4, 5}, true);
  window.known.set({9, 9, 9}, true);
  JournalContent content;
  JournalBrick far = random_brick(random_, 1);
  far.corner = {640, -80, 24};
  JournalBrick behind = far;
  behind.corner = {-128, 6, 0};
  for (const auto& brick : {far, behind}) content.bricks[brick.corner] = brick;
  RawVoxels wide = content.widened(window, 100'000'000).value();
  EXPECT_EQ(wide.known.count(), 2);
  const auto is = [&](const BitGrid& bits, Index3 voxel) {  // counted from the frame's origin
    const Vec3 first = (wide.geometry.origin_map / 0.2).array().round().matrix();
    return bits.test({voxel.x - int(first.x()), voxel.y - int(first.y()), voxel.z - int(first.z())});
  };
  EXPECT_TRUE(is(wide.known, {1, 10, 5}) && is(wide.occupied, {1, 10, 5}));
  EXPECT_TRUE(is(wide.known, {7, 15, 9}) && !is(wide.occupied, {7, 15, 9}));
  content.write_into(wide);
  for (const auto& brick : {far, behind}) {
    for (int k = 0; k < 64 * 64; ++k) {
      const int word = k / 64, bit = k % 64;
      const Index3 voxel{brick.corner.x + bit, brick.corner.y + word % 8, brick.corner.z + word / 8};
      ASSERT_EQ(is(wide.known, voxel), (brick.known[std::size_t(word)] >> bit & 1) != 0);
    }
  }
  EXPECT_EQ(content.widened(window, 1000).code(), ErrorCode::map_too_large);
}

TEST_F(Journal, BricksBeyondTheMapAreLeftOut) {
  JournalContent content;
  for (const Index3 corner : {Index3{-6400, 0, 0}, {0, 8000, 0}, {0, 0, -800}}) {
    JournalBrick brick = random_brick(random_, 1);
    brick.corner = corner;
    content.bricks[corner] = brick;
  }
  const GridGeometry geometry{Vec3(0, 0, 0), 0.2, {100, 20, 20}};
  RawVoxels voxels{geometry, BitGrid(geometry.size, true), BitGrid(geometry.size, false)};
  content.write_into(voxels);
  EXPECT_EQ(voxels.known.count(), 0);
}

}  // namespace
}  // namespace goshawk::map_server
