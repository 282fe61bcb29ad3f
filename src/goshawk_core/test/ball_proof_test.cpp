// What is flown keeps its distance from raw voxels, also where the map's grown bits reach farther.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

constexpr double kVoxel_m = 0.2;
constexpr double kBall_m = 0.2;
constexpr double kReserve_m = 0.2;

VoxelGrid open_space(Index3 size) {
  VoxelGrid grid;
  grid.geometry = {.origin_map = {-1.0, 0.4, 0.2}, .resolution_m = kVoxel_m, .size = size};
  grid.known = BitGrid(size, false, true);
  grid.raw = BitGrid(size, true, false);
  grid.inflation_m = kBall_m;
  grid.unknown_is_occupied = false;
  grid.version = 5;
  return grid;
}

FreeSpace space_of(VoxelGrid grid) {
  grid.grown = inflate(grid.raw, kBall_m + kReserve_m, kVoxel_m).value();
  return FreeSpace(std::make_shared<const VoxelGrid>(std::move(grid)));
}

/// [m] to the nearest cube that is raw or was never seen, by brute force.
double nearest_m(const VoxelGrid& grid, const Vec3& p_map) {
  double nearest = HUGE_VAL;
  const Index3 size = grid.geometry.size;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (!grid.raw.get({x, y, z}) && grid.known.get({x, y, z})) continue;
        const Vec3 low = grid.geometry.lower_corner({x, y, z});
        const Vec3 in = p_map.cwiseMax(low).cwiseMin(low + Vec3::Constant(kVoxel_m));
        nearest = std::min(nearest, (p_map - in).norm());
      }
    }
  }
  return nearest;
}

BezierPiece line(const Vec3& from, const Vec3& to) {
  return BezierPiece::between({.position = from}, {.position = to}, 2.0);
}

TEST(BallProof, ACurveIsFreeExactlyAsLongAsTheBallKeepsOutOfWhatIsOccupiedOrUnseen) {
  Random random(11);
  int free = 0, blocked = 0, rescued = 0;
  for (int run = 0; run < 300; ++run) {
    VoxelGrid grid = open_space({40, 12, 10});
    const int things = 1 + random.below(12);
    for (int i = 0; i < things; ++i) {
      const Index3 at{random.below(40), random.below(12), random.below(10)};
      if (random.chance(0.5)) {
        grid.raw.set(at, true);
      } else {
        grid.known.set(at, false);
      }
    }
    const FreeSpace space = space_of(grid);
    const auto point = [&] {
      return Vec3(random.uniform(-0.9, 6.9), random.uniform(0.5, 2.7), random.uniform(0.3, 2.1));
    };
    BezierPiece curve = line(point(), point());
    for (int c = 0; c < 6; ++c) curve.control_points.col(c) += 0.3 * (point() - point()) / 4.0;
    const Vec3 low = curve.control_points.rowwise().minCoeff();
    const Vec3 high = curve.control_points.rowwise().maxCoeff();
    if ((low - grid.geometry.origin_map).minCoeff() < 0.0) continue;
    if ((grid.geometry.upper_corner_map() - high).minCoeff() < 0.0) continue;
    const auto found = find_obstruction(space, curve);
    const double until_s = found ? found->time_s : curve.duration_s;
    // A curve that is blocked at its start claims nothing. kTouch_m is what a proof may give away.
    for (int i = 0; i <= 400 && until_s > 0.0; ++i) {
      const double t_s = until_s * i / 400;
      ASSERT_GE(nearest_m(grid, curve.sample(t_s).position), kBall_m - 1.01 * kTouch_m);
    }
    if (found) {
      ++blocked;
      ASSERT_LE(nearest_m(grid, curve.sample(until_s).position), kBall_m + 1e-6);
    } else {
      ++free;
      rescued += find_obstruction(*space.grid(), curve) ? 1 : 0;
    }
  }
  EXPECT_GT(free, 30);
  EXPECT_GT(blocked, 30);
  EXPECT_GT(rescued, 10) << "free, though the reserve is grown there";
}

TEST(BallProof, AVoxelInTheReserveBlocksPlansButNotWhatIsFlown) {
  VoxelGrid grid = open_space({40, 12, 10});
  grid.raw.set({20, 3, 5}, true);  // y from 1.0 to 1.2 m
  const FreeSpace space = space_of(grid);
  const auto beside = [&](double y) { return line(Vec3(0.0, y, 1.3), Vec3(6.0, y, 1.3)); };
  EXPECT_TRUE(find_obstruction(*space.grid(), beside(1.45)));
  EXPECT_FALSE(find_obstruction(space, beside(1.45)));
  EXPECT_TRUE(space.is_free({20, 5, 5}));
  const auto found = find_obstruction(space, beside(1.35));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->voxel, (Index3{20, 3, 5}));
  EXPECT_THAT(to_text(*space.grid(), *found), testing::HasSubstr("an obstacle at"));
}

TEST(BallProof, AVehicleAtRestThatIsTooNearMayLeaveButComeNoNearer) {
  VoxelGrid grid = open_space({40, 12, 10});
  grid.raw.set({20, 3, 5}, true);
  grid.raw.set({20, 7, 5}, true);
  const FreeSpace space = space_of(grid);
  const Vec3 rest(3.1, 1.3, 1.3);  // 0.1 m from the first
  const auto way = [&](const Vec3& to) { return Trajectory{{line(rest, to)}}; };
  EXPECT_FALSE(find_obstruction(space, way(rest + Vec3(0, 0.25, 0))));
  EXPECT_FALSE(find_obstruction(space, way(rest + Vec3(-1.0, 0, 0))));
  EXPECT_TRUE(find_obstruction(space, way(rest - Vec3(0, 0.05, 0)))) << "nearer to it";
  EXPECT_TRUE(find_obstruction(space, way(rest + Vec3(0, 0.4, 0)))) << "too near to the other";
  EXPECT_TRUE(find_obstruction(space, way(rest + Vec3(0, 0.25, 0)).pieces[0]))
      << "a piece alone does not begin at rest";
  Trajectory moving = way(rest + Vec3(-1.0, 0, 0));
  moving.pieces[0].control_points.col(1).x() -= 0.01;
  EXPECT_TRUE(find_obstruction(space, moving));
}

}  // namespace
}  // namespace goshawk
