// A scanned building floor; skipped if the shared data is not there.
#include <gtest/gtest.h>

#include <cstdlib>

#include "worlds.hpp"

namespace goshawk::flight_check::test {
namespace {

std::filesystem::path building() {
  const char* data = std::getenv("GOSHAWK_DATA");
  return std::filesystem::path(data != nullptr ? data : "../shared/data") / "octomap/geb079.bt";
}

/// Occupied leaves within `margin_m` of p, each as its own box: the brute force.
double nearest_leaf_m(const octomap::OcTree& tree, const Vec3& p, double margin_m) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto corner = [&](double by) {
    return octomap::point3d(float(p.x() + by), float(p.y() + by), float(p.z() + by));
  };
  for (auto leaf = tree.begin_leafs_bbx(corner(-margin_m), corner(margin_m));
       leaf != tree.end_leafs_bbx(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const Vec3 center(leaf.getX(), leaf.getY(), leaf.getZ());
    const Vec3 away = ((p - center).cwiseAbs().array() - leaf.getSize() / 2.0).cwiseMax(0.0);
    nearest = std::min(nearest, away.norm());
  }
  return nearest;
}

class RealMap : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(building())) {
      GTEST_SKIP() << "no " << building() << ": set GOSHAWK_DATA to the folder of shared maps";
    }
  }
};

TEST_F(RealMap, ASmallBodysClearanceIsThatOfItsCentre) {
  octomap::OcTree tree(0.1);
  ASSERT_TRUE(tree.readBinary(building().string()));
  const auto check = FlightCheck::open(building(), {.radius_m = 1e-3, .height_m = 2e-3}).value();
  Random random(17);
  int compared = 0;
  while (compared < 100) {
    const Vec3 p(random.uniform(-8, 30), random.uniform(-7, 7), random.uniform(0, 2.5));
    const double truth_m = nearest_leaf_m(tree, p, 1.5);
    if (truth_m > 1.4 || truth_m < 0.01) continue;
    ++compared;
    const Sample s = at(0.0, p);
    EXPECT_NEAR(check.judge(std::span(&s, 1)).value().clearance_m, truth_m, 2e-3);
  }
}

TEST_F(RealMap, AFlightThroughTheBuildingsWallsIsCaughtAtTheFirstWall) {
  const auto check = FlightCheck::open(building()).value();
  std::vector<Sample> track;
  for (int k = 0; k <= 1000; ++k) track.push_back(at(0.01 * k, Vec3(-7.0 + 0.036 * k, 0.5, 1.0)));
  const Verdict whole = check.judge(track).value();
  ASSERT_TRUE(whole.touched);
  // Two samples only, and in between the same straight line: the same verdict.
  const std::vector<Sample> ends{track.front(), track.back()};
  const Verdict jumped = check.judge(ends).value();
  EXPECT_TRUE(jumped.touched);
  EXPECT_NEAR(jumped.clearance_t_s, whole.clearance_t_s, 1e-4);
}

TEST_F(RealMap, AHoverInAFreeRoomIsClearAndStillSoWithUnknownAsObstacle) {
  octomap::OcTree tree(0.1);
  ASSERT_TRUE(tree.readBinary(building().string()));
  const Options strict{.count_unknown_as_obstacle = true};
  const auto lenient_check = FlightCheck::open(building()).value();
  const auto strict_check = FlightCheck::open(building(), {}, strict).value();
  Random random(23);
  int stricter = 0;
  for (int k = 0; k < 60; ++k) {
    const Sample s = at(0.0, Vec3(random.uniform(-8, 30), random.uniform(-7, 7), 1.0));
    const auto lenient = lenient_check.judge(std::span(&s, 1)).value();
    const auto judged = strict_check.judge(std::span(&s, 1)).value();
    EXPECT_LE(judged.clearance_m, lenient.clearance_m + 1e-4);
    if (tree.search(s.position_map.x(), s.position_map.y(), s.position_map.z()) == nullptr) {
      EXPECT_TRUE(judged.touched);
    }
    stricter += judged.clearance_m < lenient.clearance_m - 1e-3;
  }
  EXPECT_GT(stricter, 5);
}

}  // namespace
}  // namespace goshawk::flight_check::test
