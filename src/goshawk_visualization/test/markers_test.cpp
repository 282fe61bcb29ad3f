#include "markers.hpp"

#include <gtest/gtest.h>

#include <set>

namespace goshawk::visualization {
namespace {

constexpr std::int64_t kStamp_ns = 5'000'000'007;

map_server::RawVoxels solid_block(Index3 size) {
  return {{Vec3(1.0, 2.0, 3.0), 0.5, size}, BitGrid(size, true), BitGrid(size, false)};
}

void fill(map_server::RawVoxels& voxels) {
  const Index3 n = voxels.geometry.size;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) voxels.occupied.set_run(0, n.x, y, z, true);
  }
}

Trajectory straight_line(double length_m, double duration_s) {
  BezierPiece piece;
  piece.duration_s = duration_s;
  for (int k = 0; k < 6; ++k) piece.control_points.col(k) = Vec3(length_m * k / 5.0, 0.0, 1.0);
  return Trajectory{{piece}};
}

TEST(VoxelMarker, ShowsTheSurfaceAlone) {
  auto voxels = solid_block({4, 4, 4});
  fill(voxels);
  const Marker m = voxel_marker(voxels, 1000, kStamp_ns);
  EXPECT_EQ(m.points().size(), 64U - 8U);
  EXPECT_EQ(m.colors().size(), m.points().size());
  EXPECT_EQ(m.type(), 6);
  EXPECT_DOUBLE_EQ(m.scale().x(), 0.5);
  for (const auto& p : m.points()) {
    EXPECT_TRUE(p.x() == 1.25 || p.x() == 2.75 || p.y() == 2.25 || p.y() == 3.75 || p.z() == 3.25 ||
                p.z() == 4.75);
  }
}

TEST(VoxelMarker, IsThinnedToAtMostTheCubesAskedFor) {
  auto voxels = solid_block({30, 30, 30});
  fill(voxels);
  const std::size_t all = voxel_marker(voxels, 1000000, kStamp_ns).points().size();
  for (const int most : {1, 7, 100, int(all) - 1, int(all)}) {
    const std::size_t drawn = voxel_marker(voxels, most, kStamp_ns).points().size();
    EXPECT_LE(drawn, std::size_t(most));
    EXPECT_GE(drawn, std::size_t(most) / 2);
  }
  EXPECT_EQ(voxel_marker(voxels, int(all), kStamp_ns).points().size(), all);
}

TEST(VoxelMarker, OfAFreeMapIsEmpty) {
  EXPECT_TRUE(voxel_marker(solid_block({9, 9, 9}), 100, kStamp_ns).points().empty());
}

TEST(CorridorMarkers, HaveTwelveEdgesAndTwelveTrianglesABox) {
  const std::vector<Polytope> boxes{Polytope::box({0, 0, 0}, {1, 2, 3}),
                                    Polytope::box({1, 0, 0}, {4, 2, 3})};
  const Marker edges = edge_marker("corridor", boxes, 0.02, kStamp_ns);
  EXPECT_EQ(edges.points().size(), 2U * 2U * 12U);
  EXPECT_EQ(edges.ns(), "corridor");
  EXPECT_EQ(edges.type(), 5);
  EXPECT_EQ(face_marker(boxes, kStamp_ns).points().size(), 2U * 3U * 12U);
  EXPECT_EQ(edges.header().frame_id(), "map");
  EXPECT_EQ(edges.header().stamp().sec(), 5);
  EXPECT_EQ(edges.header().stamp().nanosec(), 7U);
}

TEST(TrajectoryMarker, HasAColourAPointAndEndsAtTheGoal) {
  const Marker m = trajectory_marker(straight_line(3.0, 1.5), 2.0, kStamp_ns);
  ASSERT_EQ(m.points().size(), m.colors().size());
  EXPECT_DOUBLE_EQ(m.points().front().x(), 0.0);
  EXPECT_DOUBLE_EQ(m.points().back().x(), 3.0);
  EXPECT_GT(m.colors().back().r(), 0.9F);  // at the limit
}

TEST(PathLine, GoesFromStartToEndInStepsThatAreShortEnough) {
  const auto path = path_line(straight_line(3.0, 1.52), 0.05, kStamp_ns);
  ASSERT_EQ(path.poses().size(), 32U);
  EXPECT_DOUBLE_EQ(path.poses().back().pose().position().x(), 3.0);
  for (std::size_t k = 1; k < path.poses().size(); ++k) {
    const double step_m =
        path.poses()[k].pose().position().x() - path.poses()[k - 1].pose().position().x();
    EXPECT_GT(step_m, 0.0);
    EXPECT_LE(step_m, 3.0 * 0.05 / 1.52 + 1e-9);
  }
  EXPECT_LE(path_line(straight_line(3.0, 1e6), 0.05, kStamp_ns).poses().size(), 20001U);
}

}  // namespace
}  // namespace goshawk::visualization
