#include "goshawk/core/free_curve.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

/// 30 x 12 x 10 voxels of 0.2 m, its lower corner at (1, -2, 0.3).
VoxelGrid empty_grid() {
  VoxelGrid grid;
  grid.geometry = {.origin_map = {1.0, -2.0, 0.3}, .resolution_m = 0.2, .size = {30, 12, 10}};
  grid.grown = BitGrid(grid.geometry.size, true);
  grid.version = 7;
  return grid;
}

VoxelGrid random_grid(Random& random, double share) {
  VoxelGrid grid = empty_grid();
  const Index3 n = grid.geometry.size;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) grid.grown.set({x, y, z}, random.chance(share));
    }
  }
  return grid;
}

/// Control points in the voxel coordinates of a grid.
BezierPiece curve_in(const VoxelGrid& grid, const std::vector<Vec3>& voxels,
                     double duration_s = 2.0) {
  BezierPiece piece;
  piece.duration_s = duration_s;
  for (int i = 0; i < 6; ++i) {
    piece.control_points.col(i) =
        grid.geometry.origin_map + grid.geometry.resolution_m * voxels[std::size_t(i)];
  }
  return piece;
}

BezierPiece line_in(const VoxelGrid& grid, const Vec3& from, const Vec3& to) {
  std::vector<Vec3> points;
  for (int i = 0; i < 6; ++i) points.push_back(from + i / 5.0 * (to - from));
  return curve_in(grid, points);
}

/// [voxels] how deep a point lies in blocked space, zero outside of it: the distance to the nearest
/// free voxel among those around it.
double depth_at(const VoxelGrid& grid, const Vec3& p_map) {
  const Vec3 p = grid.geometry.to_grid(p_map);
  double nearest_free = 1.0;
  const Index3 at{int(std::floor(p.x())), int(std::floor(p.y())), int(std::floor(p.z()))};
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        const Index3 i = at + Index3{x, y, z};
        if (grid.grown.test(i)) continue;
        const Vec3 lo(i.x, i.y, i.z);
        const Vec3 in = p.cwiseMax(lo).cwiseMin(lo + Vec3::Ones());
        nearest_free = std::min(nearest_free, (p - in).norm());
      }
    }
  }
  return nearest_free;
}

/// [voxels] from a point to a voxel's cube
double distance_to(const VoxelGrid& grid, Index3 i, const Vec3& p_map) {
  const Vec3 p = grid.geometry.to_grid(p_map), lo(i.x, i.y, i.z);
  return (p - p.cwiseMax(lo).cwiseMin(lo + Vec3::Ones())).norm();
}

TEST(FreeCurve, NeverSaysFreeWhereDenseSamplesAreBlockedAndNamesTheFirstPlace) {
  Random random(1);
  int free = 0, blocked = 0;
  for (int run = 0; run < 3000; ++run) {
    const VoxelGrid grid = random_grid(random, random.chance(0.5) ? 0.01 : 0.05);
    std::vector<Vec3> points;
    for (int i = 0; i < 6; ++i) {
      points.emplace_back(2.0 + 4.0 * i + random.uniform(-3, 3), random.uniform(1, 11),
                          random.uniform(1, 9));
    }
    const BezierPiece curve = curve_in(grid, points);
    const auto found = find_obstruction(grid, curve);
    const double until_s = found ? found->time_s : curve.duration_s;
    for (int i = 0; i <= 4000; ++i) {
      const double t_s = curve.duration_s * i / 4000.0;
      if (t_s >= until_s && found) break;
      ASSERT_LE(depth_at(grid, curve.sample(t_s).position), 1.01 * kTouch_m / 0.2)
          << "run " << run << " at " << t_s;
    }
    if (!found) {
      ++free;
      continue;
    }
    ++blocked;
    // And it is true: the curve is at that voxel then, which is blocked.
    ASSERT_TRUE(grid.grown.test(found->voxel));
    ASSERT_LT(distance_to(grid, found->voxel, curve.sample(found->time_s).position), 1e-3) << run;
  }
  EXPECT_GT(free, 300);
  EXPECT_GT(blocked, 300);
}

TEST(FreeCurve, FacesEdgesAndCornersMayBeTouched) {
  VoxelGrid grid = empty_grid();
  grid.grown.set({10, 5, 5}, true);
  const auto is_free = [&](const Vec3& a, const Vec3& b) {
    return !find_obstruction(grid, line_in(grid, a, b));
  };
  EXPECT_TRUE(is_free({5, 4.5, 6}, {15, 5.5, 6}));     // on its upper face
  EXPECT_TRUE(is_free({5, 5, 6}, {15, 5, 6}));         // along an edge
  EXPECT_TRUE(is_free({8, 4, 6}, {12, 8, 6}));         // in the plane of a face, over it
  EXPECT_TRUE(is_free({9, 6, 5.5}, {11, 4, 5.5}));     // through a point of an edge
  EXPECT_TRUE(is_free({9, 5, 7}, {11, 5, 5}));         // through a corner, along a face
  EXPECT_TRUE(is_free({9, 6, 7}, {11, 4, 5}));         // through a corner
  EXPECT_FALSE(is_free({9, 4, 7}, {11, 6, 5}));        // through a corner, and on inside
  EXPECT_FALSE(is_free({5, 5.5, 5.99}, {15, 5.5, 5.99}));
  EXPECT_FALSE(is_free({5, 5.0005, 5.9995}, {15, 5.0005, 5.9995}));
}

TEST(FreeCurve, BetweenTwoBlockedVoxelsThereIsNoWay) {
  VoxelGrid grid = empty_grid();
  grid.grown.set_run(8, 12, 5, 5, true);
  const BezierPiece between = line_in(grid, {5, 5.5, 6}, {15, 5.5, 6});
  EXPECT_FALSE(find_obstruction(grid, between));
  grid.grown.set_run(11, 14, 5, 6, true);
  const auto found = find_obstruction(grid, between);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->time_s, 2.0 * (11.0 - 5.0) / 10.0, 1e-3);
}

TEST(FreeCurve, TheWorldBeyondTheMapIsBlockedItsFacesAreNot) {
  const VoxelGrid grid = empty_grid();
  EXPECT_FALSE(find_obstruction(grid, line_in(grid, {0, 0, 0}, {30, 12, 10})));
  EXPECT_FALSE(find_obstruction(grid, line_in(grid, {0, 0, 0}, {30, 0, 0})));
  EXPECT_TRUE(find_obstruction(grid, line_in(grid, {1, 1, 1}, {30.01, 1, 1})));
  EXPECT_TRUE(find_obstruction(grid, line_in(grid, {1, 1, -0.01}, {5, 1, -0.01})));
  EXPECT_TRUE(find_obstruction(grid, line_in(grid, {1, 1, 1}, {1e12, 1, 1})));
  BezierPiece nan = line_in(grid, {1, 1, 1}, {2, 1, 1});
  nan.control_points(1, 3) = std::nan("");
  EXPECT_TRUE(find_obstruction(grid, nan));
}

/// A plane that a cube's corner or edge lies on, the cube beyond it. [voxels] normal and offset
HalfSpace supporting(Random& random, Index3 cube) {
  const Vec3 normal =
      Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
  double offset = kForever;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p(cube.x + (corner & 1), cube.y + (corner >> 1 & 1), cube.z + (corner >> 2));
    offset = std::min(offset, normal.dot(p));
  }
  return {normal, offset};
}

// As corridors are: planes that touch cubes, curves that lie on the planes.
TEST(FreeCurve, CurvesOnPlanesThatTouchTheCubesAreFree) {
  Random random(3);
  for (int run = 0; run < 2000; ++run) {
    VoxelGrid grid = empty_grid();
    const Index3 cube{8 + int(random.below(12)), 3 + int(random.below(6)),
                      2 + int(random.below(6))};
    grid.grown.set(cube, true);
    const HalfSpace plane = supporting(random, cube);
    // The touched corner, and two directions in the plane.
    Vec3 touched(cube.x, cube.y, cube.z);
    for (int axis = 0; axis < 3; ++axis) touched[axis] += plane.normal[axis] < 0.0 ? 1.0 : 0.0;
    const Vec3 u = Vec3(plane.normal.unitOrthogonal()), v = Vec3(plane.normal.cross(u));
    const double angle = random.uniform(0.0, 6.2831853);
    const Vec3 along = std::cos(angle) * u + std::sin(angle) * v;
    const double bend = random.uniform(-0.5, 0.5);
    std::vector<Vec3> points;
    for (int i = 0; i < 6; ++i) {
      const double s = -1.5 + 3.0 * i / 5.0;
      const Vec3 aside = plane.normal.cross(along) * bend * (s * s - 0.25);
      points.push_back(touched + s * along + aside - random.uniform(0.0, 1e-7) * plane.normal);
    }
    ASSERT_FALSE(find_obstruction(grid, curve_in(grid, points))) << run;
    // A thousandth of a voxel deeper it is seen, if that is inside of the cube.
    BezierPiece deeper = line_in(grid, touched - along, touched + along);
    for (int i = 0; i < 6; ++i) {
      deeper.control_points.col(i) += 0.2e-2 * plane.normal;
    }
    const Vec3 middle = deeper.sample(1.0).position;
    if (depth_at(grid, middle) > 2.0 * kTouch_m / 0.2) {
      ASSERT_TRUE(find_obstruction(grid, deeper));
    }
  }
}

TEST(FreeCurve, APartOfATrajectoryIsLookedAtAlone) {
  VoxelGrid grid = empty_grid();
  grid.grown.set({20, 5, 5}, true);
  Trajectory trajectory;
  trajectory.pieces = {line_in(grid, {2, 5.5, 5.5}, {12, 5.5, 5.5}),
                       line_in(grid, {12, 5.5, 5.5}, {28, 5.5, 5.5})};
  const auto found = find_obstruction(grid, trajectory, 0.0, kForever);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->time_s, 2.0 + 2.0 * 8.0 / 16.0, 1e-3);
  EXPECT_EQ(found->voxel, (Index3{20, 5, 5}));
  EXPECT_FALSE(find_obstruction(grid, trajectory, 0.0, 2.99));
  EXPECT_TRUE(find_obstruction(grid, trajectory, 0.0, 3.01));
  EXPECT_TRUE(find_obstruction(grid, trajectory, 3.05, 3.06));
  EXPECT_FALSE(find_obstruction(grid, trajectory, 3.13, kForever));
  EXPECT_FALSE(find_obstruction(grid, trajectory, 4.0, kForever));
}

TEST(FreeCurve, ACommittedTrajectoryIsRefusedWithTimePlaceAndVersion) {
  VoxelGrid grid = empty_grid();
  const Polytope anywhere = Polytope::box(Vec3::Constant(-50.0), Vec3::Constant(50.0));
  const FlatState start{.position = {2, -0.9, 1.4}}, goal{.position = {6, -0.9, 1.4}};
  Trajectory trajectory;
  trajectory.pieces = {BezierPiece::between(start, goal, 6.0)};
  auto certified = certify(trajectory, {anywhere}, {.v_max_m_s = 9, .a_max_m_s2 = 9}, start, goal);
  const auto committed =
      CommittedTrajectory::make({.id = 12, .nominal = std::move(certified).value()}).value();
  EXPECT_TRUE(check_against(grid, committed, 0.0));
  grid.grown.set(*grid.geometry.index_of({4, -0.9, 1.4}), true);
  const auto status = check_against(grid, committed, 0.0);
  EXPECT_EQ(status.code(), ErrorCode::trajectory_blocked);
  for (const char* word : {"trajectory 12", "map 7", "an obstacle", "3 s"}) {
    EXPECT_NE(status.error().message.find(word), std::string::npos) << status.error().message;
  }
  EXPECT_TRUE(check_against(grid, committed, 3.5));
}

}  // namespace
}  // namespace goshawk
