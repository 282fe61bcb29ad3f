// Walls that appear in front of a vehicle that flies into a world as it sees it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "count_of.hpp"
#include "goshawk/closed_loop/flight_lab.hpp"
#include "growing_world.hpp"
#include "unfolding_world.hpp"

namespace goshawk::goals {
namespace {

using closed_loop::FlightLab;

constexpr double kWallScan_s = 0.05;
constexpr double kOdometry_s = 0.004;
constexpr double kVoxel_m = 0.2;
const Vec3 kHall_m(30.0, 12.0, 4.0);
const Vec3 kHallStart(1.1, 6.1, 2.1);

worlds::World empty_hall() {
  GridGeometry geometry{.resolution_m = kVoxel_m, .size = {150, 60, 20}};
  return {geometry, BitGrid(geometry.size, true, false)};
}

/// Voxels of a wall, one to two thick, 3 m to each side and as high as the hall.
std::vector<Index3> wall(const Vec3& middle, const Vec3& normal) {
  std::vector<Index3> voxels;
  const GridGeometry geometry = empty_hall().geometry;
  for (int z = 0; z < geometry.size.z; ++z) {
    for (int y = 0; y < geometry.size.y; ++y) {
      for (int x = 0; x < geometry.size.x; ++x) {
        const Vec3 off = geometry.center({x, y, z}) - middle;
        const double across = normal.dot(off);
        if (std::abs(across) > kVoxel_m) continue;
        const Vec3 along = off - across * normal;
        if (along.head<2>().norm() < 3.0) voxels.push_back({x, y, z});
      }
    }
  }
  return voxels;
}

double nearest_m(const std::vector<Index3>& voxels, const Vec3& p_map) {
  double nearest = HUGE_VAL;
  for (const Index3 v : voxels) {
    const Vec3 lo = kVoxel_m * Vec3(v.x, v.y, v.z);
    nearest = std::min(nearest,
                       (p_map - p_map.cwiseMax(lo).cwiseMin(lo + Vec3::Constant(kVoxel_m))).norm());
  }
  return nearest;
}

struct WallCase {
  double v_max_m_s;
  double a_max_m_s2;
};

struct WallTally {
  int walls = 0;
  double fastest_m_s = 0.0;
  double nearest_m = 1.0;
  double error_m = 0.0;
};

/// One flight in which walls appear ahead, at any angle, at the nearest distance that still fits:
/// to brake at a_max, to be seen with the next scan and heard with the next odometry, the body, the
/// margin, and a voxel, for obstacles fill their voxels.
void fly_at_walls(std::uint64_t seed, const WallCase& limits, WallTally& tally) {
  Random random(seed);
  UnfoldingWorld world(empty_hall(), 6.0);
  world.see_from(kHallStart);
  navigator::Config config;
  config.v_max_m_s = limits.v_max_m_s;
  config.a_max_m_s2 = limits.a_max_m_s2;
  config.unknown = UnknownSpace::free;
  tracker::Config tracker;
  tracker.stop_acceleration_m_s2 =
      std::max(tracker.stop_acceleration_m_s2, 2.0 * limits.a_max_m_s2);
  FlightLab lab(world.map(), seed,
                {.navigator = config, .tracker = tracker, .home_map = kHallStart});
  lab.set_truth(world.truth());
  double next_scan_s = lab.now_s();
  lab.watch = [&] {
    tally.nearest_m =
        std::min(tally.nearest_m, obstacle_distance_m(*world.truth(), lab.position(), 0.5));
    tally.fastest_m_s = std::max(tally.fastest_m_s, lab.speed());
    if (lab.now_s() < next_scan_s) return;
    next_scan_s = lab.now_s() + kWallScan_s;
    if (world.see_from(lab.position())) lab.set_map(world.map());
  };
  ASSERT_TRUE(lab.goal(Vec3(kHall_m.x() - 1.1, random.uniform(2.0, 10.0), 2.1)));
  for (int k = 0; k < 3; ++k) {
    lab.run(random.uniform(0.5, 4.0), [&] { return lab.settled(); });
    if (lab.speed() < 0.3) continue;
    const Vec3 ahead = lab.velocity().normalized();
    const double turn = random.uniform(-1.2, 1.2), tilt = random.uniform(-0.5, 0.5);
    const Vec3 normal =
        (Eigen::AngleAxisd(turn, Vec3::UnitZ()) * Eigen::AngleAxisd(tilt, Vec3::UnitY()) * ahead)
            .normalized();
    const double v = lab.speed(), a = limits.a_max_m_s2;
    const double fits_m = v * v / (2.0 * a) + v * (kWallScan_s + kOdometry_s + 0.001) + kBody_m +
                          kTrackingMargin_m + kVoxel_m;
    std::vector<Index3> voxels;
    for (double d = fits_m; voxels.empty() || nearest_m(voxels, lab.position()) < fits_m;
         d += 0.02) {
      voxels = wall(lab.position() + d * ahead, normal);
      if (voxels.empty() || d > 8.0) break;
    }
    if (voxels.empty()) continue;
    world.add(voxels);
    lab.set_truth(world.truth());
    ++tally.walls;
    lab.run(1.5);
    ASSERT_EQ(lab.contacts(), 0) << "at " << v << " m/s, wall " << k << " turned by " << turn;
  }
  tally.error_m = std::max(tally.error_m, lab.max_error_m());
}

TEST(Walls, ThatAppearWhereBrakingStillFitsAreNeverTouched) {
  const int walls = count_of("GOSHAWK_WALLS", 9);
  constexpr WallCase kCases[] = {{1.0, 2.0}, {2.0, 2.0}, {2.0, 3.0}, {3.0, 3.0}, {3.0, 4.0}};
  WallTally tally;
  for (std::uint64_t seed = 1; tally.walls < walls; ++seed) {
    SCOPED_TRACE(seed);
    ASSERT_NO_FATAL_FAILURE(fly_at_walls(seed, kCases[seed % std::size(kCases)], tally));
  }
  std::printf(
      "%d walls, none touched: nearest %.3f m from the centre, fastest %.2f m/s, largest "
      "tracking error %.4f m\n",
      tally.walls, tally.nearest_m, tally.fastest_m_s, tally.error_m);
  EXPECT_GT(tally.nearest_m, kBody_m);
}

}  // namespace
}  // namespace goshawk::goals
