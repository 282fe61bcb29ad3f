// The same scans into the live map and into OctoMap: every voxel agrees, but those that a ray
// touches so closely that OctoMap's floats decide.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <octomap/octomap_utils.h>

#include <algorithm>

#include "goshawk/core/random.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "scan.hpp"
#include "scan_support.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kSkin_voxels = 2e-3;

struct SeenRay {
  Vec3 from, to;  // [voxels] cut at the range
  bool hits;
};

// Does a ray pass the voxel's skin, or end in it, without passing through what is inside?
bool explains(const SeenRay& ray, const Vec3& corner) {
  const bool near = testing::share_inside(ray.from, ray.to, corner, kSkin_voxels) >= 0.0;
  if (!near) return false;
  const bool through = testing::share_inside(ray.from, ray.to, corner, -kSkin_voxels) > 0.0;
  const Vec3 end = ray.to - corner;
  const bool end_near = (end.array() > -kSkin_voxels).all() && (end.array() < 1.0 + kSkin_voxels).all();
  const bool end_inside = (end.array() > kSkin_voxels).all() && (end.array() < 1.0 - kSkin_voxels).all();
  return !through || (end_near && !end_inside);
}

class Pair {
 public:
  Pair(const Box& box, double resolution_m)
      : tree_(resolution_m), map_(make(box, resolution_m)), resolution_m_(resolution_m) {}

  void insert(const std::vector<Vec3>& points, const Vec3& from, double range_m) {
    ASSERT_TRUE(map_server::insert_scan(tree_, points, from, range_m));
    ASSERT_TRUE(testing::insert(map_, points, from, range_m));
    for (const Vec3& p : points) {
      const double length = (p - from).norm();
      const bool hits = length <= range_m;
      const Vec3 to = hits ? p : Vec3(from + (p - from) * (range_m / length));
      rays_.push_back({from / resolution_m_, to / resolution_m_, hits});
    }
  }

  // @return share of the known voxels that differ
  double compare() const {
    const VoxelGrid grid = map_.grid();
    std::int64_t known = 0, different = 0, unexplained = 0;
    for (int z = 0; z < grid.geometry.size.z; ++z) {
      for (int y = 0; y < grid.geometry.size.y; ++y) {
        for (int x = 0; x < grid.geometry.size.x; ++x) {
          const Vec3 centre = grid.geometry.center({x, y, z});
          const auto* node = tree_.search(centre.x(), centre.y(), centre.z());
          const bool same = grid.known.get({x, y, z}) == (node != nullptr) &&
                            grid.raw.get({x, y, z}) == (node != nullptr && tree_.isNodeOccupied(node));
          known += node != nullptr ? 1 : 0;
          if (same) continue;
          ++different;
          const Vec3 corner = grid.geometry.lower_corner({x, y, z}) / resolution_m_;
          const bool explained = std::ranges::any_of(
              rays_, [&](const SeenRay& ray) { return explains(ray, corner); });
          unexplained += explained ? 0 : 1;
        }
      }
    }
    EXPECT_GT(known, 1000);
    EXPECT_EQ(unexplained, 0) << "of " << different << " different ones";
    return double(different) / double(known);
  }

 private:
  static LiveMap make(const Box& box, double resolution_m) {
    LiveOptions options;
    options.odds = OddsModel::octomap();
    options.keep_grazed = false;
    return LiveMap::unknown_space(box, resolution_m, {UnknownPolicy::free, 0.0}, options).value();
  }

  octomap::OcTree tree_;
  LiveMap map_;
  double resolution_m_;
  std::vector<SeenRay> rays_;
};

TEST(OctoMapAgreement, OfScansFromManyPlaces) {
  Random random(21);
  for (int round = 0; round < 6; ++round) {
    Pair pair({Vec3(-7, -7, -3), Vec3(7, 7, 3)}, 0.2);
    for (int scan = 0; scan < 12; ++scan) {
      const Vec3 from(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-1, 1));
      std::vector<Vec3> points;
      for (int i = 0; i < 150; ++i) {
        points.push_back(Vec3(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-3, 3)));
      }
      pair.insert(points, from, 5.0);
    }
    EXPECT_LT(pair.compare(), 1e-3);
  }
}

TEST(OctoMapAgreement, OfARealScan) {
  GOSHAWK_NEED_DATA(path, "clouds/autoware_test.pcd");
  std::vector<Vec3> points;
  const auto all = load_points(path).value();
  for (std::size_t i = 0; i < all.size(); i += 11) {
    if (all[i].allFinite() && all[i].norm() > 0.5) points.push_back(all[i]);
  }
  Pair pair({Vec3(-32, -32, -4), Vec3(32, 32, 6)}, 0.2);
  for (int scan = 0; scan < 3; ++scan) pair.insert(points, Vec3(0.013 * scan, 0.007, 0.005), 30.0);
  EXPECT_LT(pair.compare(), 1e-3);
}

// Every sequence of hits and misses: the bytes decide as the floats do.
TEST(OctoMapAgreement, OfEverySequenceOfTwelveScans) {
  int different = 0;
  for (int sequence = 0; sequence < 4096; ++sequence) {
    const OddsModel model = OddsModel::octomap();
    int value = 0;
    double odds = 0.0;
    for (int k = 0; k < 12; ++k) {
      const bool hit = (sequence >> k & 1) != 0;
      value = std::clamp(value + (hit ? model.hit : -model.miss), model.least, model.most);
      odds = std::clamp(odds + (hit ? double(octomap::logodds(0.7)) : double(octomap::logodds(0.4))),
                        double(octomap::logodds(0.1192)), double(octomap::logodds(0.971)));
      different += (value >= model.occupied) != (odds >= 0.0) ? 1 : 0;
    }
  }
  EXPECT_EQ(different, 0);
}

}  // namespace
}  // namespace goshawk::map_server
