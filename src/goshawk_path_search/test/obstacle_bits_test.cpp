#include "goshawk/path_search/obstacle_bits.hpp"

#include <gtest/gtest.h>

#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;

TEST(ObstacleBits, HoldTheMapInsideABlockedLayer) {
  Random random(7);
  for (int n = 0; n < 200; ++n) {
    const BitGrid map = reference::any_map(random);
    ObstacleBits bits;
    bits.assign(map);
    for (int z = 0; z < map.size().z; ++z) {
      for (int y = 0; y < map.size().y; ++y) {
        for (int x = 0; x < map.size().x; ++x) {
          const Index3 at{x, y, z};
          const auto node = bits.node(at);
          ASSERT_EQ(bits.index(node), at);
          ASSERT_EQ(bits.blocked(node), map.get(at));
          const BlockMask block = bits.block(node);
          for (int d = 0; d < kDirections; ++d) {
            ASSERT_EQ((block >> d & 1U) != 0, map.test(at + step_of(d)));
          }
        }
      }
    }
  }
}

TEST(ObstacleBits, FollowAMapThatChanges) {
  Random random(8);
  ObstacleBits kept;
  for (int n = 0; n < 100; ++n) {
    const BitGrid map = reference::noise_map({65, 6, 5}, random.uniform(), random);
    kept.assign(map);
    ObstacleBits fresh;
    fresh.assign(map);
    for (int k = 0; k < 200; ++k) {
      const Index3 at{random.below(65), random.below(6), random.below(5)};
      ASSERT_EQ(kept.block(kept.node(at)), fresh.block(fresh.node(at)));
      if (map.get(at)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(kept.straight_jump(CornerRule::squeeze, axis, 1, at),
                  fresh.straight_jump(CornerRule::squeeze, axis, 1, at));
      }
    }
  }
}

// Each version shares chunks with the one before, as updates make them.
TEST(ObstacleBits, FollowUpdatesOfAMapLikeANewMap) {
  Random random(10);
  for (int n = 0; n < 10; ++n) {
    BitGrid map = reference::noise_map({70, 20, 19}, 0.2, random);
    ObstacleBits kept;
    kept.assign(map);
    for (int update = 0; update < 20; ++update) {
      for (int k = random.below(30); k > 0; --k) {
        map.set({random.below(70), random.below(20), random.below(19)}, random.chance(0.5));
      }
      kept.assign(map);
      ObstacleBits fresh;
      fresh.assign(map);
      for (int k = 0; k < 70 * 20 * 19; ++k) {
        const Index3 at{k % 70, k / 70 % 20, k / 70 / 20};
        ASSERT_EQ(kept.block(kept.node(at)), fresh.block(fresh.node(at)));
        for (int axis = 0; axis < 3 && !map.get(at); ++axis) {
          ASSERT_EQ(kept.straight_jump(CornerRule::no_squeeze, axis, -1, at),
                    fresh.straight_jump(CornerRule::no_squeeze, axis, -1, at));
        }
      }
    }
  }
}

// Voxel by voxel, with the rules for one move: how far does a straight jump go?
int walked_jump(const BitGrid& map, CornerRule rule, int direction, Index3 at) {
  ObstacleBits bits;
  bits.assign(map);
  for (int steps = 1;; ++steps) {
    at = at + step_of(direction);
    if (map.test(at)) return 1 - steps;
    const auto moves = move_rules(rule).successors(direction, bits.block(bits.node(at)));
    if ((moves & ~(BlockMask{1} << direction)) != 0) return steps;
    if (steps == ObstacleBits::kLongestJump) return steps;
  }
}

TEST(ObstacleBits, JumpStraightToTheFirstForcedNeighbourOrObstacle) {
  for (const CornerRule rule : {CornerRule::no_squeeze, CornerRule::squeeze}) {
    Random random(9);
    for (int n = 0; n < 3000; ++n) {
      const bool sparse = random.chance(0.5);
      const BitGrid map = sparse ? reference::noise_map(reference::odd_size(random),
                                                        random.uniform(0.0, 0.03), random)
                                 : reference::any_map(random);
      const Index3 at = reference::free_voxel(map, random);
      if (map.get(at)) continue;
      ObstacleBits bits;
      bits.assign(map);
      for (int axis = 0; axis < 3; ++axis) {
        for (const int sign : {-1, 1}) {
          const Index3 step{axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0};
          ASSERT_EQ(bits.straight_jump(rule, axis, sign, at),
                    walked_jump(map, rule, direction_of(step), at))
              << "map " << n << " axis " << axis << " sign " << sign;
        }
      }
    }
  }
}

}  // namespace
}  // namespace goshawk::path_search
