// What follows and bends a path, and what joins polytopes: each against brute force.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../src/detour.hpp"
#include "../src/voxel_walk.hpp"
#include "../src/waypoints.hpp"
#include "support/worlds.hpp"

namespace goshawk::corridor_builder {
namespace {

using test_support::add_noise;
using test_support::empty_world;

Vec3 point_in(Index3 size, Random& random) {
  // Half of them on the raster of half voxels: faces, edges, corners and centres are met exactly.
  const bool exact = random.chance(0.5);
  Vec3 p;
  const int n[3] = {size.x, size.y, size.z};
  for (int a = 0; a < 3; ++a) {
    p[a] = exact ? 0.5 * random.below(2 * n[a] + 1) : random.uniform(0.0, n[a]);
  }
  return p;
}

bool share_a_face(Index3 a, Index3 b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z) == 1;
}

// Does the segment meet the closed cube? By clipping, with what rounding may take.
bool segment_meets(const Vec3& p, const Vec3& q, Index3 voxel) {
  const Vec3 lower(voxel.x, voxel.y, voxel.z), d = q - p;
  double from = 0.0, to = 1.0;
  for (int a = 0; a < 3; ++a) {
    const double lo = lower[a] - 1e-9, hi = lower[a] + 1.0 + 1e-9;
    if (d[a] == 0.0) {
      if (p[a] < lo || p[a] > hi) return false;
      continue;
    }
    const double u = (lo - p[a]) / d[a], v = (hi - p[a]) / d[a];
    from = std::max(from, std::min(u, v));
    to = std::min(to, std::max(u, v));
  }
  return from <= to;
}

// Is there a way over faces through free voxels that the segment meets? Floods all of them.
bool flood_reaches(const BitGrid& occupied, const Vec3& p, const Vec3& q) {
  std::vector<Index3> met;
  const Index3 n = occupied.size();
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        if (!occupied.get({x, y, z}) && segment_meets(p, q, {x, y, z})) met.push_back({x, y, z});
      }
    }
  }
  std::vector<bool> reached(met.size());
  for (std::size_t i = 0; i < met.size(); ++i) reached[i] = holds(met[i], p);
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t i = 0; i < met.size(); ++i) {
      for (std::size_t j = 0; j < met.size() && !reached[i]; ++j) {
        if (reached[j] && share_a_face(met[i], met[j])) reached[i] = grew = true;
      }
    }
  }
  for (std::size_t i = 0; i < met.size(); ++i) {
    if (reached[i] && holds(met[i], q)) return true;
  }
  return false;
}

TEST(VoxelWalk, FindsAWayOverFacesIfAndOnlyIfThereIsOne) {
  Random random(31);
  VoxelWalk walk;
  int ways = 0, none = 0;
  for (int k = 0; k < 3000; ++k) {
    SCOPED_TRACE(k);
    VoxelGrid grid = empty_world({9, 7, 5}, 1.0);
    add_noise(grid, random.uniform(0.0, 0.5), random);
    const Vec3 p = point_in(grid.geometry.size, random), q = point_in(grid.geometry.size, random);
    std::vector<Index3> voxels;
    const bool found = walk.append(grid.grown, p, q, voxels);
    ASSERT_EQ(found, flood_reaches(grid.grown, p, q));
    (found ? ways : none) += 1;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      ASSERT_FALSE(grid.grown.get(voxels[i]));
      ASSERT_TRUE(segment_meets(p, q, voxels[i]));
      ASSERT_TRUE(i == 0 || share_a_face(voxels[i - 1], voxels[i]));
    }
    if (!found) continue;
    ASSERT_TRUE(holds(voxels.front(), p));
    ASSERT_TRUE(holds(voxels.back(), q));
  }
  EXPECT_GT(ways, 500);
  EXPECT_GT(none, 500);
}

TEST(VoxelWalk, GoesOnFromTheLastVoxelOfThePathSoFar) {
  const VoxelGrid grid = empty_world({8, 8, 2}, 1.0);
  VoxelWalk walk;
  std::vector<Index3> voxels;
  ASSERT_TRUE(walk.append(grid.grown, Vec3(0.5, 0.5, 0.5), Vec3(4.5, 0.5, 0.5), voxels));
  const std::size_t before = voxels.size();
  ASSERT_TRUE(walk.append(grid.grown, Vec3(4.5, 0.5, 0.5), Vec3(4.5, 6.5, 0.5), voxels));
  EXPECT_EQ(voxels.size(), before + 6);
  EXPECT_EQ(voxels.back(), (Index3{4, 6, 0}));
  for (std::size_t i = 1; i < voxels.size(); ++i) {
    EXPECT_TRUE(share_a_face(voxels[i - 1], voxels[i]));
  }
}

// The distance of a tapering capsule from a box, by trying many points of its axis.
double room_left(const Segment& s, const Obstacle& o) {
  double least = 1e9;
  for (int i = 0; i <= 1000; ++i) {
    const double t = i / 1000.0;
    const Vec3 x = s.p + t * (s.q - s.p);
    const double distance = (x.cwiseMax(o.lower).cwiseMin(o.upper) - x).norm();
    least = std::min(least, distance - o.radius - (1.0 - t) * s.needed.p - t * s.needed.q);
  }
  return least;
}

// p, between, q with their balls keep out of every obstacle.
void expect_free(const BoxSet& obstacles, const Segment& s, const std::vector<Vec3>& between) {
  Vec3 from = s.p;
  double radius = s.needed.p;
  for (std::size_t i = 0; i <= between.size(); ++i) {
    const bool last = i == between.size();
    const Vec3 to = last ? s.q : between[i];
    const double to_radius = last ? s.needed.q : kHalfVoxel;
    const Room room{radius, to_radius};
    for (std::size_t b = 0; b < obstacles.size(); ++b) {
      ASSERT_GT(room_left({from, to, room, room}, obstacles.at(b)), -1e-5) << "part " << i;
    }
    from = to;
    radius = to_radius;
  }
}

TEST(Detour, PushesAPathAwayUntilHalfAVoxelIsFreeAllAlongIt) {
  Random random(32);
  Detour detour;
  const Bounds map{Vec3::Zero(), Vec3(20, 20, 20)};
  int bent = 0, straight = 0, given_up = 0;
  for (int k = 0; k < 2000; ++k) {
    SCOPED_TRACE(k);
    BoxSet obstacles;
    for (int i = 0; i < 30; ++i) {
      const Vec3 lower(random.below(18), random.below(18), random.below(18));
      obstacles.add(lower, lower + Vec3(1 + random.below(3), 1 + random.below(3), 1));
    }
    const Room room{0.0, random.chance(0.5) ? kHalfVoxel : 0.0};
    const Segment s{Vec3(random.uniform(1, 19), random.uniform(1, 19), random.uniform(1, 19)),
                    Vec3(random.uniform(1, 19), random.uniform(1, 19), random.uniform(1, 19)), room,
                    room};
    std::vector<Vec3> between;
    if (!detour.push_away(obstacles, map, s, between)) {
      ++given_up;
      continue;
    }
    (between.empty() ? straight : bent) += 1;
    ASSERT_NO_FATAL_FAILURE(expect_free(obstacles, s, between));
    for (const Vec3& w : between) {
      ASSERT_TRUE(((w - map.lower).array() >= kHalfVoxel).all());
      ASSERT_TRUE(((map.upper - w).array() >= kHalfVoxel).all());
    }
  }
  EXPECT_GT(straight, 300);
  EXPECT_GT(bent, 100);
  EXPECT_GT(given_up, 100);
}

TEST(Detour, FollowsVoxelCentresWithAsFewAsItCan) {
  // An L of free voxels around a box: one centre, at its corner, is enough.
  BoxSet obstacles;
  obstacles.add(Vec3(0, 1, 0), Vec3(4, 6, 1));
  std::vector<Vec3> centres;
  for (int x = 0; x <= 4; ++x) centres.emplace_back(x + 0.5, 0.5, 0.5);
  for (int y = 1; y <= 5; ++y) centres.emplace_back(4.5, y + 0.5, 0.5);
  const Room room{kHalfVoxel, kHalfVoxel};
  const Segment s{centres.front(), centres.back(), room, room};
  Detour detour;
  std::vector<Vec3> between;
  ASSERT_TRUE(detour.along(obstacles, s, centres, false, between));
  ASSERT_EQ(between.size(), 1U);
  EXPECT_EQ(between[0], Vec3(4.5, 0.5, 0.5));
  ASSERT_TRUE(detour.along(obstacles, s, centres, true, between));
  ASSERT_EQ(between.size(), 2U);
  EXPECT_EQ(between[1], centres.back());
  expect_free(obstacles, s, between);
}

// Boxes in a row along x that share 0.2 to 2 m with their neighbours.
Chain row_of_boxes(int n, Random& random) {
  Chain chain;
  double x = 0.0;
  chain.waypoints_map.emplace_back(0.1, random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4));
  for (int k = 0; k < n; ++k) {
    const double length = random.uniform(2.5, 6.0);
    const Vec3 half(0.0, random.uniform(0.5, 2.0), random.uniform(0.5, 2.0));
    chain.append() = Polytope::box(Vec3(x, 0, 0) - half, Vec3(x + length, 0, 0) + half);
    x += length - (k + 1 < n ? random.uniform(0.2, 2.0) : 0.0);
    chain.waypoints_map.emplace_back(x, random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
  }
  chain.waypoints_map.back().x() -= 0.1;
  return chain;
}

bool inside(const Chain& chain, std::size_t polytope, const Vec3& p) {
  return chain[polytope].violation(p) <= 1e-9;
}

TEST(Waypoints, SettleWhereBothPolytopesKeepTheClearanceOrTheBallIfThatIsSmaller) {
  Random random(33);
  for (int k = 0; k < 300; ++k) {
    SCOPED_TRACE(k);
    Chain chain = row_of_boxes(2 + random.below(5), random);
    const auto before = chain.waypoints_map;
    measure_overlaps(chain);
    ASSERT_EQ(chain.overlaps.size(), chain.size() - 1);
    const double clearance_m = random.uniform(0.0, 0.6);
    settle_waypoints(clearance_m, chain);
    EXPECT_EQ(chain.waypoints_map.front(), before.front());
    EXPECT_EQ(chain.waypoints_map.back(), before.back());
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const double kept = std::min(clearance_m, chain.overlaps[i].radius_m);
      const Vec3& w = chain.waypoints_map[i + 1];
      EXPECT_LE(chain[i].violation(w), -kept + 1e-9);
      EXPECT_LE(chain[i + 1].violation(w), -kept + 1e-9);
      // No farther than needed: one that had the room stays.
      const bool had_room = chain[i].violation(before[i + 1]) <= -kept &&
                            chain[i + 1].violation(before[i + 1]) <= -kept;
      EXPECT_TRUE(!had_room || w == before[i + 1]);
    }
  }
}

TEST(Waypoints, OnlyCoveredPolytopesAreDroppedAndNeighboursStillShareABall) {
  Random random(34);
  std::size_t dropped = 0;
  for (int k = 0; k < 300; ++k) {
    SCOPED_TRACE(k);
    Chain chain = row_of_boxes(3 + random.below(5), random);
    // A box between two that already overlap well is covered.
    const std::size_t n = chain.size();
    measure_overlaps(chain);
    const Vec3 start = chain.waypoints_map.front(), goal = chain.waypoints_map.back();
    drop_covered(0.2, 0.05, 0.05, chain);
    dropped += n - chain.size();
    ASSERT_EQ(chain.waypoints_map.size(), chain.size() + 1);
    ASSERT_EQ(chain.overlaps.size(), chain.size() - 1);
    EXPECT_EQ(chain.waypoints_map.front(), start);
    EXPECT_EQ(chain.waypoints_map.back(), goal);
    EXPECT_TRUE(inside(chain, 0, start));
    EXPECT_TRUE(inside(chain, chain.size() - 1, goal));
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const Ball& ball = chain.overlaps[i];
      EXPECT_GT(ball.radius_m, 0.09);
      EXPECT_LE(chain[i].violation(ball.center_map), -ball.radius_m + 1e-6);
      EXPECT_LE(chain[i + 1].violation(ball.center_map), -ball.radius_m + 1e-6);
    }
  }
  EXPECT_EQ(dropped, 0U);  // each box here is needed: the next but one does not touch it

  Chain covered;
  covered.waypoints_map = {Vec3(0.5, 0, 0), Vec3(3, 0, 0), Vec3(4, 0, 0), Vec3(8, 0, 0)};
  covered.append() = Polytope::box(Vec3(0, -1, -1), Vec3(5, 1, 1));
  covered.append() = Polytope::box(Vec3(2, -1, -1), Vec3(6, 1, 1));
  covered.append() = Polytope::box(Vec3(3, -1, -1), Vec3(9, 1, 1));
  measure_overlaps(covered);
  drop_covered(0.2, 0.05, 0.05, covered);
  ASSERT_EQ(covered.size(), 2U);
  EXPECT_NEAR(covered.overlaps[0].radius_m, 1.0, 1e-6);
}

}  // namespace
}  // namespace goshawk::corridor_builder
