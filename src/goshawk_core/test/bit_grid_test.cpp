#include "goshawk/core/bit_grid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <thread>
#include <vector>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

constexpr int kHuge = std::numeric_limits<int>::max();

// Sizes on both sides of the boundaries of words and of chunks.
const std::vector<Index3> kSizes{{1, 1, 1},   {5, 4, 3},   {63, 3, 2},  {64, 3, 2},  {65, 3, 2},
                                 {127, 2, 3}, {128, 1, 2}, {130, 2, 2}, {5, 17, 9}, {70, 8, 16}};

struct Reference {  // a bool a voxel
  explicit Reference(Index3 s)
      : size(s), bits(std::size_t(s.x) * std::size_t(s.y) * std::size_t(s.z)) {}
  std::vector<bool>::reference at(Index3 i) {
    const int row = i.z * size.y + i.y;
    return bits[std::size_t(row) * std::size_t(size.x) + std::size_t(i.x)];
  }
  Index3 size;
  std::vector<bool> bits;
};

void expect_equal(const BitGrid& grid, Reference& reference) {
  std::int64_t set = 0;
  const Index3 s = grid.size();
  for (int z = -1; z <= s.z; ++z) {
    for (int y = -1; y <= s.y; ++y) {
      for (int x = -2; x <= s.x + 70; ++x) {
        const Index3 i{x, y, z};
        const bool inside = x >= 0 && x < s.x && y >= 0 && y < s.y && z >= 0 && z < s.z;
        ASSERT_EQ(grid.contains(i), inside) << to_text(i);
        ASSERT_EQ(grid.test(i), inside ? bool(reference.at(i)) : grid.outside()) << to_text(i);
        if (inside) {
          ASSERT_EQ(grid.get(i), bool(reference.at(i)));
          set += grid.get(i) ? 1 : 0;
        }
      }
    }
  }
  ASSERT_EQ(grid.count(), set);
}

void expect_padding_is_outside(const BitGrid& grid) {
  for (int z = 0; z < grid.size().z; ++z) {
    for (int y = 0; y < grid.size().y; ++y) {
      for (int x = grid.size().x; x < int(64 * grid.words_per_row()); ++x) {
        ASSERT_EQ((grid.row(y, z)[x / 64] >> (x % 64)) & 1U, grid.outside() ? 1U : 0U);
      }
    }
  }
}

TEST(BitGrid, StoresWhatIsSetAndKeepsThePadding) {
  Random random(1);
  for (const Index3 size : kSizes) {
    for (const bool outside : {false, true}) {
      BitGrid grid(size, outside);
      Reference reference(size);
      expect_equal(grid, reference);
      for (int n = 0; n < 300; ++n) {
        const Index3 i{random.below(size.x), random.below(size.y), random.below(size.z)};
        const bool value = random.chance(0.6);
        grid.set(i, value);
        reference.at(i) = value;
      }
      expect_equal(grid, reference);
      expect_padding_is_outside(grid);
    }
  }
}

TEST(BitGrid, SetsRunsLikeSingleVoxels) {
  Random random(2);
  for (const Index3 size : kSizes) {
    BitGrid grid(size, true);
    Reference reference(size);
    for (int n = 0; n < 200; ++n) {
      int x0 = random.below(size.x + 1);
      int x1 = random.below(size.x + 1);
      if (n == 0) x0 = 0, x1 = size.x;  // a whole row
      if (x0 > x1) std::swap(x0, x1);
      const int y = random.below(size.y);
      const int z = random.below(size.z);
      const bool value = n == 0 || random.chance(0.5);
      grid.set_run(x0, x1, y, z, value);
      for (int x = x0; x < x1; ++x) reference.at({x, y, z}) = value;
    }
    expect_equal(grid, reference);
    expect_padding_is_outside(grid);
  }
}

TEST(BitGrid, FillsEveryVoxelAndNoPadding) {
  for (const Index3 size : kSizes) {
    for (const bool outside : {false, true}) {
      const BitGrid grid(size, outside, true);
      EXPECT_EQ(grid.count(), grid.voxels());
      EXPECT_EQ(grid.voxels(), std::int64_t{size.x} * size.y * size.z);
      expect_padding_is_outside(grid);
    }
  }
}

TEST(BitGrid, AdoptsWordsAndRepairsTheirPadding) {
  Random random(3);
  for (const Index3 size : kSizes) {
    for (const bool outside : {false, true}) {
      const std::size_t per_row = BitGrid(size, outside).words_per_row();
      std::vector<BitGrid::Word> words(per_row * std::size_t(size.y * size.z));
      for (auto& word : words) word = random.next();
      const auto grid = BitGrid::from_words(size, outside, words);
      ASSERT_TRUE(grid.ok());
      expect_padding_is_outside(*grid);
      Reference reference(size);
      for (std::size_t w = 0; w < words.size(); ++w) {
        const int row = int(w / per_row);
        for (int bit = 0; bit < 64; ++bit) {
          const Index3 i{int(w % per_row) * 64 + bit, row % size.y, row / size.y};
          if (i.x < size.x) reference.at(i) = ((words[w] >> bit) & 1U) != 0;
        }
      }
      expect_equal(*grid, reference);
      EXPECT_EQ(BitGrid::from_words(size, outside, grid->to_words()).value(), *grid);
    }
  }
}

TEST(BitGrid, RefusesWordsOfTheWrongNumber) {
  for (const std::size_t words : {0U, 5U, 7U}) {
    const auto grid = BitGrid::from_words({65, 3, 1}, true, std::vector<BitGrid::Word>(words));
    ASSERT_FALSE(grid.ok());
    EXPECT_EQ(grid.code(), ErrorCode::invalid_input);
    EXPECT_NE(grid.error().message.find("needs 6 words"), std::string::npos);
  }
  EXPECT_EQ(BitGrid::from_words({0, 3, 1}, true, {}).code(), ErrorCode::map_empty);
}

TEST(BitGrid, ChecksSizesWithoutOverflow) {
  EXPECT_EQ(BitGrid::check_size({0, 1, 1}).code(), ErrorCode::map_empty);
  EXPECT_EQ(BitGrid::check_size({1, -1, 1}).code(), ErrorCode::map_empty);
  EXPECT_EQ(BitGrid::check_size({1, 1, -kHuge}).code(), ErrorCode::map_empty);
  EXPECT_EQ(BitGrid::check_size({kHuge, kHuge, kHuge}).code(), ErrorCode::map_too_large);
  EXPECT_EQ(BitGrid::check_size({4, kHuge, kHuge}).code(), ErrorCode::map_too_large);
  EXPECT_TRUE(BitGrid::check_size({2048, 2048, 2048}).ok());
  EXPECT_EQ(BitGrid::check_size({2048, 2048, 2049}).code(), ErrorCode::map_too_large);
  EXPECT_THROW(BitGrid({0, 1, 1}, true), std::logic_error);
  EXPECT_THROW(BitGrid({kHuge, kHuge, kHuge}, true), std::logic_error);
}

// Random writes to a set of copies of each other; each must stay what was written to it.
TEST(BitGrid, CopiesAreValuesThoughTheyShareChunks) {
  Random random(4);
  const Index3 size{70, 20, 18};
  std::vector<BitGrid> grids{BitGrid(size, true)};
  std::vector<Reference> references{Reference(size)};
  for (int n = 0; n < 3000; ++n) {
    const auto k = std::size_t(random.below(int(grids.size())));
    if (random.chance(0.02)) {
      const auto from = std::size_t(random.below(int(grids.size())));
      if (grids.size() < 5) {
        grids.push_back(grids[from]);
        references.push_back(references[from]);
      } else {
        grids[k] = grids[from];
        references[k] = references[from];
      }
      continue;
    }
    const Index3 i{random.below(size.x), random.below(size.y), random.below(size.z)};
    const bool value = random.chance(0.6);
    grids[k].set(i, value);
    references[k].at(i) = value;
  }
  for (std::size_t k = 0; k < grids.size(); ++k) expect_equal(grids[k], references[k]);
}

TEST(BitGrid, AWriteClonesOneChunkAndNoneThatNobodyElseHas) {
  BitGrid grid({64, 40, 40}, true);
  grid.set({3, 17, 20}, true);
  const BitGrid before = grid;
  EXPECT_EQ(grid.row(17, 20), before.row(17, 20)) << "shared";
  grid.set({4, 17, 20}, true);
  EXPECT_NE(grid.row(17, 20), before.row(17, 20));
  EXPECT_EQ(grid.row(24, 20), before.row(24, 20));
  const BitGrid::Word* own = grid.row(17, 20);
  grid.set({5, 18, 21}, true);
  EXPECT_EQ(grid.row(17, 20), own) << "nobody else had this chunk";
}

TEST(BitGrid, TellsWhichChunksDiffer) {
  Random random(5);
  for (const Index3 size : kSizes) {
    BitGrid before(size, false);
    for (int n = 0; n < 20; ++n) {
      before.set({random.below(size.x), random.below(size.y), random.below(size.z)}, true);
    }
    BitGrid after = before;
    for (int n = 0; n < 3; ++n) {
      const Index3 i{random.below(size.x), random.below(size.y), random.below(size.z)};
      if (random.chance(0.3)) after.set(i, before.get(i));  // a write that changes nothing
      if (random.chance(0.5)) after.set(i, !before.get(i));
    }
    BitGrid patched = before;
    int visited = 0;
    for_changed_chunks(before, after, [&](BitGrid::Rows rows) {
      ++visited;
      bool differs = false;
      for (int z = rows.z0; z < rows.z1; ++z) {
        for (int y = rows.y0; y < rows.y1; ++y) {
          for (std::size_t w = 0; w < after.words_per_row(); ++w) {
            differs |= patched.row(y, z)[w] != after.row(y, z)[w];
            patched.mutable_row(y, z)[w] = after.row(y, z)[w];
          }
        }
      }
      EXPECT_TRUE(differs);
    });
    EXPECT_LE(visited, 3);
    EXPECT_EQ(patched, after);
    // The same content from elsewhere shares nothing, and shares all once that was asked for.
    BitGrid again = BitGrid::from_words(size, false, after.to_words()).value();
    again.share_equal_chunks(after);
    EXPECT_EQ(again.row(0, 0), after.row(0, 0));
    for_changed_chunks(again, after, [](BitGrid::Rows) { FAIL(); });
  }
}

TEST(BitGrid, ReadersOfOlderVersionsAreNotDisturbed) {
  const Index3 size{130, 24, 24};
  BitGrid grid(size, true);
  std::vector<std::thread> readers;
  for (int version = 0; version < 40; ++version) {
    const BitGrid held = grid;  // on to a thread that reads while this one goes on writing
    readers.emplace_back([held, version] {
      for (int n = 0; n < 20; ++n) ASSERT_EQ(held.count(), 3 * version);
    });
    for (int k = 0; k < 3; ++k) grid.set({3 * version + k, version % 24, (7 * version) % 24}, true);
  }
  for (auto& reader : readers) reader.join();
  EXPECT_EQ(grid.count(), 120);
}

TEST(BitGrid, ShiftsByBricksLikeVoxelByVoxel) {
  Random random(6);
  for (const Index3 size : {Index3{70, 9, 17}, {128, 16, 16}, {200, 20, 7}}) {
    for (const bool outside : {false, true}) {
      BitGrid grid(size, outside);
      for (int n = 0; n < 2000; ++n) {
        grid.set({random.below(size.x), random.below(size.y), random.below(size.z)}, true);
      }
      for (int n = 0; n < 40; ++n) {
        const Index3 bricks{random.below(7) - 3, random.below(7) - 3, random.below(7) - 3};
        const bool value = random.chance(0.5);
        const BitGrid moved = grid.shifted(bricks, value);
        Reference expected(size);
        for (int k = 0; k < size.x * size.y * size.z; ++k) {
          const Index3 i{k % size.x, k / size.x % size.y, k / size.x / size.y};
          const Index3 from{i.x + 64 * bricks.x, i.y + 8 * bricks.y, i.z + 8 * bricks.z};
          expected.at(i) = grid.contains(from) ? grid.get(from) : value;
        }
        expect_equal(moved, expected);
        expect_padding_is_outside(moved);
      }
    }
  }
  const BitGrid wide({64, 32, 32}, true);
  EXPECT_EQ(wide.shifted({0, 1, 1}, false).row(0, 0), wide.row(8, 8)) << "chunks are shared";
}

TEST(BitGrid, GivesAWindowLikeVoxelByVoxel) {
  Random random(7);
  for (int n = 0; n < 200; ++n) {
    const Index3 size{1 + random.below(150), 1 + random.below(20), 1 + random.below(12)};
    BitGrid grid(size, random.chance(0.5));
    for (int k = 0; k < 300; ++k) {
      grid.set({random.below(size.x), random.below(size.y), random.below(size.z)}, true);
    }
    const Index3 lower{random.below(200) - 100, random.below(20) - 10, random.below(20) - 10};
    const Index3 cut{1 + random.below(150), 1 + random.below(12), 1 + random.below(12)};
    const BitGrid window = grid.window(lower, cut);
    Reference expected(cut);
    for (int k = 0; k < cut.x * cut.y * cut.z; ++k) {
      const Index3 i{k % cut.x, k / cut.x % cut.y, k / cut.x / cut.y};
      expected.at(i) = grid.test(i + lower);
    }
    expect_equal(window, expected);
    expect_padding_is_outside(window);
  }
}

TEST(BitGrid, AnEmptyGridIsAllOutside) {
  const BitGrid grid;
  EXPECT_TRUE(grid.empty());
  EXPECT_FALSE(grid.contains({0, 0, 0}));
  EXPECT_TRUE(grid.test({0, 0, 0}));
  EXPECT_EQ(grid.count(), 0);
  EXPECT_TRUE(BitGrid({1, 1, 1}, false).test({kHuge, -kHuge, 0}) == false);
}

}  // namespace
}  // namespace goshawk
