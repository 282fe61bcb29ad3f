#include "goshawk/obstacle_tracker/clusters.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "goshawk/core/random.hpp"

namespace goshawk::obstacle_tracker {
namespace {

std::vector<MovingPoint> random_points(Random& random, int count, double most) {
  std::vector<MovingPoint> points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-most, most), y = random.uniform(-most, most);
    points.push_back({Vec3(x, y, random.uniform(-most, most)), 0.1 * i, random.chance(0.5)});
  }
  return points;
}

bool belong_together(const Vec3& a, const Vec3& b, double cell_m, int reach_z) {
  const Vec3 d = ((a / cell_m).array().floor() - (b / cell_m).array().floor()).abs();
  return d.x() <= 1.0 && d.y() <= 1.0 && d.z() <= reach_z;
}

// Truth: every pair, joined until nothing changes. @return how many points each cluster has, sorted
std::vector<int> brute_force(const std::vector<MovingPoint>& points, double cell_m, int reach_z) {
  std::vector<std::size_t> of(points.size());
  std::iota(of.begin(), of.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (of[i] == of[j]) continue;
        if (!belong_together(points[i].p_map, points[j].p_map, cell_m, reach_z)) continue;
        of[i] = of[j] = std::min(of[i], of[j]);
        changed = true;
      }
    }
  }
  std::vector<int> counts;
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (const auto n = std::ranges::count(of, i); n > 0) counts.push_back(int(n));
  }
  std::ranges::sort(counts);
  return counts;
}

TEST(Clusters, AreThoseOfBruteForce) {
  Random random(4);
  Clusters clusters(0.25, 0.5);  // two empty cells between two
  for (int run = 0; run < 60; ++run) {
    const auto points = random_points(random, 80, random.uniform(0.5, 3.0));
    std::vector<int> counts;
    for (const Cluster& c : clusters.group(points)) counts.push_back(c.points);
    std::ranges::sort(counts);
    EXPECT_EQ(counts, brute_force(points, 0.25, 3)) << run;
  }
}

TEST(Clusters, TellBoxTimeAndEvidence) {
  Clusters clusters(0.25, 0.5);
  const std::vector<MovingPoint> points{{Vec3(1.0, 2.0, 0.5), 1.0, true},
                                        {Vec3(1.2, 2.1, 1.0), 3.0, false},
                                        {Vec3(9.0, 9.0, 9.0), 5.0, true}};
  const auto found = clusters.group(points);
  ASSERT_EQ(found.size(), 2u);
  const Cluster& pair = found[0].points == 2 ? found[0] : found[1];
  EXPECT_EQ(pair.lower_map, Vec3(1.0, 2.0, 0.5));
  EXPECT_EQ(pair.upper_map, Vec3(1.2, 2.1, 1.0));
  EXPECT_EQ(pair.t_s, 2.0);
  EXPECT_EQ(pair.standing_free, 1);
}

TEST(Clusters, NoPointsAndPointsAtTheWorldsEndAreNoTrouble) {
  Clusters clusters(0.25, 0.5);
  EXPECT_TRUE(clusters.group({}).empty());
  const std::vector<MovingPoint> far{{Vec3(1e9, 0, 0), 0.0, true}};
  EXPECT_TRUE(clusters.group(far).empty());
}

}  // namespace
}  // namespace goshawk::obstacle_tracker
