#include "brick_archive.hpp"

#include <gtest/gtest.h>

#include "goshawk/core/random.hpp"

namespace goshawk::map_server {
namespace {

BrickMap::Bits random_bits(Random& random) {
  BrickMap::Bits bits;
  for (std::size_t row = 0; row < Brick::kWords; ++row) {
    const int kind = random.below(3);
    bits.known[row] = kind == 0 ? 0 : kind == 1 ? ~std::uint64_t{0} : random.next();
    bits.raw[row] = random.chance(0.5) ? bits.known[row] & random.next() : 0;
  }
  return bits;
}

TEST(BrickArchive, GivesBackWhatItKeeps) {
  Random random(2);
  BrickArchive archive(100'000'000);
  std::vector<BrickMap::Bits> all;
  for (int i = 0; i < 200; ++i) {
    all.push_back(random_bits(random));
    archive.keep({i - 100, 3 * i, -i}, all.back());
  }
  EXPECT_EQ(archive.bricks(), 200U);
  for (int i = 0; i < 200; ++i) {
    const auto kept = archive.take({i - 100, 3 * i, -i});
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->raw, all[std::size_t(i)].raw);
    EXPECT_EQ(kept->known, all[std::size_t(i)].known);
    EXPECT_FALSE(archive.take({i - 100, 3 * i, -i}));
  }
  EXPECT_EQ(archive.memory_bytes(), 0);
  EXPECT_EQ(archive.forgotten(), 0);
}

TEST(BrickArchive, ForgetsWhatCameFirstWhenMemoryIsShort) {
  BrickMap::Bits free;
  free.known.fill(~std::uint64_t{0});
  BrickArchive archive(10'000);
  for (int i = 0; i < 1000; ++i) archive.keep({i, 0, 0}, free);
  EXPECT_LE(archive.memory_bytes(), 10'000);
  EXPECT_EQ(std::int64_t(archive.bricks()) + archive.forgotten(), 1000);
  EXPECT_FALSE(archive.take({0, 0, 0}));
  EXPECT_TRUE(archive.take({999, 0, 0}));
}

TEST(BrickArchive, FlyingToAndFroKeepsTheYoungest) {
  BrickMap::Bits free;
  free.known.fill(~std::uint64_t{0});
  BrickArchive archive(2'000);
  for (int i = 0; i < 20'000; ++i) {
    archive.keep({7, 7, 7}, free);
    ASSERT_TRUE(archive.take({7, 7, 7}));
  }
  archive.keep({7, 7, 7}, free);
  EXPECT_EQ(archive.bricks(), 1U);
  EXPECT_EQ(archive.forgotten(), 0);
}

}  // namespace
}  // namespace goshawk::map_server
