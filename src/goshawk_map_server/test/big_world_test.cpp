// A flight across a world much larger than the window, by default 200 m of it; with
// GOSHAWK_BIG_WORLD_M=1000 the whole.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "goshawk/map_server/live_map.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kVoxel_m = 0.2, kSight_m = 20.0, kCeiling_m = 50.0;
constexpr double kPillars_m = 16.0;  // from one to the next
constexpr int kRaysAround = 120, kRings = 10;

double length_m() {
  const char* chosen = std::getenv("GOSHAWK_BIG_WORLD_M");
  return chosen != nullptr ? std::stod(chosen) : 200.0;
}

// Pillars of 1 m on a square raster, from the ground up; the way lies between them.
double range_to_pillars(const Vec3& from, const Vec3& way) {
  const double step = 0.1, across = std::hypot(way.x(), way.y());
  for (double range = 0.5; range < kSight_m / across; range += step) {
    const Vec3 p = from + range * way;
    if (p.z() < 0.0) return range;
    const auto off = [](double v) { return std::abs(v - kPillars_m * std::round(v / kPillars_m)); };
    if (off(p.x()) < 0.5 && off(p.y()) < 0.5) return range;
  }
  return 10.0 * kSight_m;
}

std::vector<Vec3> scan_from(const Vec3& from) {
  std::vector<Vec3> points;
  for (int row = 0; row < kRings; ++row) {
    const double up = 0.5 * (double(row) / (kRings - 1) - 0.5);
    for (int k = 0; k < kRaysAround; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kRaysAround;
      const Vec3 way(std::cos(angle) * std::cos(up), std::sin(angle) * std::cos(up), std::sin(up));
      points.push_back(from + range_to_pillars(from, way) * way);
    }
  }
  return points;
}

class BigWorld : public ::testing::Test {
 protected:
  static LiveMap make(const Vec3& origin, std::int64_t max_kept_bytes) {
    LiveOptions options;
    options.follows = true;
    options.max_kept_bytes = max_kept_bytes;
    const Box box{origin + Vec3(-40, -40, 0), origin + Vec3(40, 40, kCeiling_m)};
    return LiveMap::unknown_space(box, kVoxel_m, {UnknownPolicy::blocked, 0.3}, options).value();
  }

  // @return the largest memory [byte] from `begin_m` to `end_m` of the way
  std::int64_t fly(LiveMap& map, const Vec3& origin, double begin_m, double end_m) {
    std::int64_t most = 0;
    const double step = begin_m < end_m ? 1.0 : -1.0;
    for (double x = begin_m; step * (end_m - x) >= 0.0; x += step) {
      const Vec3 from(x + 0.07, 0.5 * kPillars_m + 0.03, 5.13);  // off the faces of voxels
      std::vector<Vec3> points = scan_from(from);
      for (Vec3& p : points) p += origin;
      const Vec3 at = from + origin;
      const Scan scan{.points_map = points, .origins_map = {&at, 1}, .max_range_m = kSight_m};
      EXPECT_TRUE(map.insert_scan(scan, result_));
      most = std::max(most, map.memory_bytes());
    }
    return most;
  }

  ScanResult result_;
};

TEST_F(BigWorld, IsFlownAcrossInFlatMemoryAndNothingIsForgottenThatFits) {
  LiveMap map = make(Vec3::Zero(), 1'000'000'000);
  const std::int64_t at_first = fly(map, Vec3::Zero(), 0.0, 60.0);
  const std::int64_t later = fly(map, Vec3::Zero(), 61.0, length_m());
  RecordProperty("first_60_m_bytes", std::to_string(at_first));
  RecordProperty("most_bytes", std::to_string(later));
  // What is kept of the way takes a little; the window takes what it took.
  EXPECT_LT(later, at_first + at_first / 4 + std::int64_t(20'000 * length_m()));
  EXPECT_EQ(map.bricks_forgotten(), 0);
  fly(map, Vec3::Zero(), length_m(), length_m() - 30.0);
  fly(map, Vec3::Zero(), 30.0, 0.0);
  const VoxelGrid grid = map.grid();
  EXPECT_TRUE(grid.raw.get(*grid.geometry.index_of(Vec3(16.1, 15.5, 5.3))));
}

TEST_F(BigWorld, WithLittleMemoryTheOldestIsForgottenAndMemoryStaysFlat) {
  LiveMap map = make(Vec3::Zero(), 200'000);
  const std::int64_t at_first = fly(map, Vec3::Zero(), 0.0, 100.0);
  const std::int64_t later = fly(map, Vec3::Zero(), 101.0, length_m());
  EXPECT_LT(later, at_first + at_first / 4);
  EXPECT_GT(map.bricks_forgotten(), 0);
}

// The raster is of whole numbers: 5,000 km from its origin the same voxels come out.
TEST_F(BigWorld, FarFromTheOriginTheMapIsTheSame) {
  const Vec3 utm(500'000.0, 5'000'000.0, 0.0);
  LiveMap near = make(Vec3::Zero(), 1'000'000'000), far = make(Vec3::Zero(), 1'000'000'000);
  fly(near, Vec3::Zero(), 0.0, 30.0);
  fly(far, utm, 0.0, 30.0);
  const VoxelGrid a = near.grid(), b = far.grid();
  std::int64_t known = 0, different = 0;
  for (int z = 0; z < a.geometry.size.z; ++z) {
    for (int y = 0; y < a.geometry.size.y; ++y) {
      for (int x = 0; x < a.geometry.size.x; ++x) {
        if (!a.known.get({x, y, z})) continue;
        const auto there = b.geometry.index_of(a.geometry.center({x, y, z}) + utm);
        if (!there) continue;  // the windows moved in steps of bricks
        ++known;
        different += a.raw.get({x, y, z}) != b.raw.get(*there) ||
                             a.known.get({x, y, z}) != b.known.get(*there)
                         ? 1
                         : 0;
      }
    }
  }
  EXPECT_GT(known, 20000);
  EXPECT_LT(double(different), 1e-3 * double(known));
}

}  // namespace
}  // namespace goshawk::map_server
