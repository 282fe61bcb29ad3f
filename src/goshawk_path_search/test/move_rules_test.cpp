#include "goshawk/path_search/move_rules.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <queue>

#include "goshawk/path_search/successor_order.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;
constexpr CornerRule kRules[] = {CornerRule::no_squeeze, CornerRule::squeeze};
constexpr BlockMask kAll = (BlockMask{1} << kDirections) - 1;

BlockMask blocked_bits(const BitGrid& block) {
  BlockMask mask = 0;
  for (int d = 0; d < kDirections; ++d) {
    if (block.get(step_of(d) + Index3{1, 1, 1})) mask |= BlockMask{1} << d;
  }
  return mask;
}

double length_of(int direction) {
  return std::sqrt(double(axes_changed(direction)));
}

// What the canonical order must do at the block's centre, judged by a search of the block.
void expect_sound(CornerRule rule, int direction, const BitGrid& block) {
  const bool squeeze = rule == CornerRule::squeeze;
  const Index3 center{1, 1, 1}, before = center - step_of(direction);
  if (block.get(center) || block.get(before) ||
      !reference::move_is_allowed(block, before, center, squeeze)) {
    return;
  }
  BitGrid without_center = block;
  if (squeeze) without_center.set(center, true);
  // Under no-squeeze a move past the centre needs it free, so it is left in the block; a way over
  // it is then as long as the one that is judged.
  const auto around = reference::distances(without_center, before, squeeze);
  const BlockMask moves = move_rules(rule).successors(direction, blocked_bits(block));
  for (int d = 0; d < kDirections; ++d) {
    if (d == kNoDirection) continue;
    const Index3 target = center + step_of(d);
    const bool made = (moves >> d & 1U) != 0;
    const bool allowed = reference::move_is_allowed(block, center, target, squeeze);
    if (!allowed) {
      ASSERT_FALSE(made);
      continue;
    }
    const double other = reference::distance_to(around, block.size(), target);
    const double through = length_of(direction) + length_of(d);
    if (!made) {
      ASSERT_LE(other, through + 1e-12);
    }
    if (other < through - 1e-12) {
      ASSERT_FALSE(made) << direction << " " << d;
    }
  }
}

TEST(MoveRules, PruneOnlyWhatAnotherWayInTheBlockReachesAndAllThatIsReachedSooner) {
  for (const CornerRule rule : kRules) {
    Random random(5);
    for (int n = 0; n < 400; ++n) {
      const BitGrid block = reference::noise_map({3, 3, 3}, random.uniform(0.05, 0.6), random);
      for (int d = 0; d < kDirections; ++d) {
        if (d != kNoDirection) expect_sound(rule, d, block);
        if (HasFatalFailure()) FAIL() << "block " << n;
      }
    }
  }
}

// The voxels that occur in any bypass of any target.
BlockMask relevant_voxels(CornerRule rule, int direction) {
  BlockMask relevant = 0;
  for (int t = 0; t < kDirections; ++t) {
    if (t == kNoDirection) continue;
    for (const BlockMask cells : bypasses(rule, direction, t)) relevant |= cells;
  }
  return relevant;
}

BitGrid block_of(BlockMask blocked) {
  BitGrid block({3, 3, 3}, true);
  for (int d = 0; d < kDirections; ++d) {
    if ((blocked >> d & 1U) != 0) block.set(step_of(d) + Index3{1, 1, 1}, true);
  }
  return block;
}

// Every state of every voxel that can force a neighbour, for all 26 arrivals and both rules; the
// other voxels once free and once by chance.
TEST(MoveRules, AreSoundInEveryNeighbourhoodThatMatters) {
  Random random(16);
  for (const CornerRule rule : kRules) {
    for (int d = 0; d < kDirections; ++d) {
      if (d == kNoDirection) continue;
      const BlockMask relevant = relevant_voxels(rule, d);
      BlockMask blocked = 0;
      do {
        expect_sound(rule, d, block_of(blocked));
        expect_sound(rule, d, block_of(blocked | (BlockMask(random.next()) & kAll & ~relevant)));
        if (HasFatalFailure()) FAIL() << "arrival " << d << ", blocked " << blocked;
        blocked = (blocked - relevant) & relevant;  // the next subset
      } while (blocked != 0);
    }
  }
}

// Exhaustive: the lookup gives what the bypass sets say, for every state of the voxels that occur
// in them.
TEST(MoveRules, LookUpWhatTheBypassesSay) {
  for (const CornerRule rule : kRules) {
    for (int d = 0; d < kDirections; ++d) {
      std::array<std::vector<BlockMask>, kDirections> ways;
      BlockMask relevant = 0;
      for (int t = 0; t < kDirections; ++t) {
        if (t == kNoDirection) continue;
        ways[std::size_t(t)] = bypasses(rule, d, t);
        for (const BlockMask cells : ways[std::size_t(t)]) relevant |= cells;
      }
      ASSERT_LE(std::popcount(relevant), 12);
      BlockMask blocked = 0;
      do {
        const BlockMask moves = move_rules(rule).successors(d, blocked);
        for (int t = 0; t < kDirections; ++t) {
          if (t == kNoDirection) continue;
          bool needed = (cells_of_move(rule, {}, step_of(t)) & blocked) == 0;
          for (const BlockMask cells : ways[std::size_t(t)]) needed &= (cells & blocked) != 0;
          ASSERT_EQ((moves >> t & 1U) != 0, needed) << d << " " << t << " " << blocked;
        }
        blocked = (blocked - relevant) & relevant;  // the next subset
      } while (blocked != 0);
    }
  }
}

// In free space each kind of move has the natural successors of the diagonal-first order: 1, 3, 7.
TEST(MoveRules, KeepOneThreeOrSevenSuccessorsInFreeSpace) {
  for (const CornerRule rule : kRules) {
    for (int d = 0; d < kDirections; ++d) {
      const int axes = axes_changed(d);
      const int expected = axes == 0 ? 26 : (1 << axes) - 1;
      EXPECT_EQ(std::popcount(move_rules(rule).successors(d, 0)), expected) << d;
    }
    EXPECT_EQ(move_rules(rule).successors(kNoDirection, kAll), 0U);
  }
}

TEST(MoveRules, AllowByMasksWhatTheTableAllowsInEveryBlock) {
  Random random(14);
  for (const CornerRule rule : kRules) {
    for (int n = 0; n < 200000; ++n) {
      const auto bits = BlockMask(random.next() & random.next());
      const BlockMask blocked =
          (n % 2 == 0 ? bits : ~bits) & kAll & ~(BlockMask{1} << kNoDirection);
      ASSERT_EQ(MoveRules::allowed(rule, blocked),
                move_rules(rule).successors(kNoDirection, blocked))
          << blocked;
    }
  }
}

TEST(SuccessorOrder, KnowsTheRiseOfEveryMoveFromItsCaseAlone) {
  Random random(15);
  SuccessorOrder order;
  for (int n = 0; n < 200000; ++n) {
    const int reach = n % 2 == 0 ? 3 : 40;
    const auto any = [&] { return random.below(2 * reach + 1) - reach; };
    const Index3 left{any(), any(), any()};
    const SuccessorOrder::Case& c = order.of(left);
    BlockMask all = 0;
    for (std::size_t level = 0; level < SuccessorOrder::kLevels; ++level) {
      ASSERT_EQ(all & c.moves[level], 0U);
      all |= c.moves[level];
      for (BlockMask m = c.moves[level]; m != 0; m &= m - 1) {
        const int d = std::countr_zero(m);
        const Cost rise = kMoves[std::size_t(d)].cost + OctileHeuristic{}(step_of(d), left) -
                          OctileHeuristic{}({}, left);
        ASSERT_EQ(Cost{c.rise[std::size_t(d)]}, rise) << to_text(left) << " " << d;
        ASSERT_GE(rise, Cost{c.least[level]});
      }
    }
    ASSERT_EQ(all, kAll & ~(BlockMask{1} << kNoDirection));
  }
}

TEST(MoveCosts, ApproximateRootsTo3In10To11) {
  EXPECT_NEAR(double(kMoveCost[2]) / double(kMoveCost[1]), std::sqrt(2.0), 3e-11 * std::sqrt(2.0));
  EXPECT_NEAR(double(kMoveCost[3]) / double(kMoveCost[1]), std::sqrt(3.0), 3e-11 * std::sqrt(3.0));
}

TEST(Heuristics, NeverDropByMoreThanAMoveCosts) {
  Random random(6);
  for (int n = 0; n < 100000; ++n) {
    const Index3 a{random.below(100), random.below(100), random.below(100)};
    const Index3 goal{random.below(100), random.below(100), random.below(100)};
    const int d = random.below(kDirections);
    const Cost move = kMoveCost[std::size_t(axes_changed(d))];
    ASSERT_LE(OctileHeuristic{}(a, goal), move + OctileHeuristic{}(a + step_of(d), goal));
    ASSERT_LE(EuclideanHeuristic{}(a, goal), OctileHeuristic{}(a, goal));
  }
}

}  // namespace
}  // namespace goshawk::path_search
