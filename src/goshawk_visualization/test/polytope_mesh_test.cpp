#include "goshawk/visualization/polytope_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "goshawk/core/random.hpp"

namespace goshawk::visualization {
namespace {

/// By the divergence theorem, which also needs the faces closed and turned outwards.
double volume(const std::vector<Polygon>& faces) {
  double six_volumes = 0.0;
  for (const Polygon& face : faces) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      six_volumes += face[0].dot(face[i].cross(face[i + 1]));
    }
  }
  return six_volumes / 6.0;
}

Polytope random_polytope(Random& random, int cuts) {
  const Vec3 center(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(0, 5));
  Polytope polytope = Polytope::box(center.array() - 1.0, center.array() + 1.0);
  for (int k = 0; k < cuts; ++k) {
    const Vec3 n =
        Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    polytope.add(n, n.dot(center) + random.uniform(0.5, 1.5));
  }
  return polytope;
}

TEST(FacePolygons, OfABoxAreItsSixSides) {
  const auto faces = face_polygons(Polytope::box({1, 2, 3}, {2, 4, 6}));
  ASSERT_EQ(faces.size(), 6U);
  for (const Polygon& face : faces) EXPECT_EQ(face.size(), 4U);
  EXPECT_NEAR(volume(faces), 1.0 * 2.0 * 3.0, 1e-9);
}

TEST(FacePolygons, HoldTheVolumeThatSamplingFinds) {
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const Polytope polytope = random_polytope(random, 12);
    const auto faces = face_polygons(polytope);
    Vec3 lower = faces[0][0], upper = faces[0][0];
    for (const Polygon& face : faces) {
      for (const Vec3& p : face) {
        EXPECT_NEAR(polytope.violation(p), 0.0, 1e-9);
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
      }
    }
    constexpr int kPoints = 20000;
    int inside = 0;
    for (int i = 0; i < kPoints; ++i) {
      const Vec3 p(random.uniform(lower.x(), upper.x()), random.uniform(lower.y(), upper.y()),
                   random.uniform(lower.z(), upper.z()));
      inside += polytope.violation(p) <= 0.0;
    }
    const double box = (upper - lower).prod();
    EXPECT_NEAR(volume(faces), box * inside / kPoints, 0.025 * box);
  }
}

TEST(FacePolygons, LeaveOutPlanesThatDoNotBound) {
  Polytope polytope = Polytope::box({0, 0, 0}, {1, 1, 1});
  polytope.add(Vec3::UnitX(), 5.0);
  polytope.add(Vec3::UnitX(), 1.0);  // again
  EXPECT_EQ(face_polygons(polytope).size(), 6U);
  EXPECT_NEAR(volume(face_polygons(polytope)), 1.0, 1e-9);
}

TEST(FacePolygons, OfAnEmptyPolytopeAreNone) {
  Polytope polytope = Polytope::box({0, 0, 0}, {1, 1, 1});
  polytope.add(Vec3::UnitX(), -1.0);
  EXPECT_TRUE(face_polygons(polytope).empty());
  EXPECT_TRUE(face_polygons(Polytope{}).empty());
}

double volume(const Mesh& mesh) {
  std::vector<Polygon> faces;
  for (const auto& face : mesh.faces) {
    Polygon& polygon = faces.emplace_back();
    for (const std::size_t i : face) polygon.push_back(mesh.corners[i]);
  }
  return volume(faces);
}

// Is every edge passed once in each direction?
bool is_closed(const Mesh& mesh) {
  std::map<std::pair<std::size_t, std::size_t>, int> passed;
  for (const auto& face : mesh.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) ++passed[{face[i], face[(i + 1) % face.size()]}];
  }
  return std::ranges::all_of(passed, [&](const auto& edge) {
    const auto back = passed.find({edge.first.second, edge.first.first});
    return edge.second == 1 && back != passed.end() && back->second == 1;
  });
}

TEST(ClosedMesh, IsClosedTurnedOutwardsAndAsLargeAsThePolytope) {
  Random random(7);
  for (int k = 0; k < 300; ++k) {
    const Polytope polytope = random_polytope(random, k % 30);
    const Mesh mesh = closed_mesh(polytope);
    ASSERT_TRUE(is_closed(mesh)) << k;
    const std::size_t corners = mesh.corners.size(), faces = mesh.faces.size();
    std::size_t edges = 0;
    for (const auto& face : mesh.faces) edges += face.size();
    EXPECT_EQ(corners + faces, edges / 2 + 2);  // Euler
    EXPECT_NEAR(volume(mesh), volume(face_polygons(polytope)), 1e-5);
    for (const Vec3& p : mesh.corners) EXPECT_NEAR(polytope.violation(p), 0.0, 1e-9);
  }
}

TEST(ClosedMesh, StaysClosedWherePlanesNearlyMeetInAPoint) {
  Random random(8);
  for (int k = 0; k < 300; ++k) {
    Polytope polytope = Polytope::box({0, 0, 0}, {1, 1, 1});
    const Vec3 corner(1, random.chance(0.5), 1);
    for (int cut = 1 + random.below(4); cut > 0; --cut) {
      const Vec3 n = Vec3(1, random.uniform(-1, 1), random.uniform(0, 1)).normalized();
      const double off = std::pow(10.0, random.uniform(-13, -3)) * (random.chance(0.5) ? 1 : -1);
      polytope.add(n, n.dot(corner) + off);
    }
    const Mesh mesh = closed_mesh(polytope);
    EXPECT_TRUE(is_closed(mesh)) << k;
    EXPECT_NEAR(volume(mesh), volume(face_polygons(polytope)), 1e-5);
  }
}

TEST(Edges, OfABoxAreItsTwelve) {
  const Mesh mesh = closed_mesh(Polytope::box({1, 2, 3}, {2, 4, 6}));
  double length_m = 0.0;
  for (const auto& [from, to] : edges(mesh)) {
    length_m += (mesh.corners[from] - mesh.corners[to]).norm();
  }
  EXPECT_EQ(edges(mesh).size(), 12U);
  EXPECT_NEAR(length_m, 4.0 * (1.0 + 2.0 + 3.0), 1e-9);
}

TEST(Edges, LieOnTwoPlanesEachAndAreListedOnce) {
  Random random(11);
  for (int k = 0; k < 50; ++k) {
    const Polytope polytope = random_polytope(random, 12);
    const Mesh mesh = closed_mesh(polytope);
    const auto found = edges(mesh);
    EXPECT_EQ(mesh.corners.size() + mesh.faces.size(), found.size() + 2);  // Euler
    EXPECT_EQ(std::set(found.begin(), found.end()).size(), found.size());
    for (const auto& [from, to] : found) {
      const Vec3 middle = 0.5 * (mesh.corners[from] + mesh.corners[to]);
      EXPECT_GE(((polytope.A() * middle - polytope.b()).array() > -1e-5).count(), 2);
    }
  }
}

TEST(Edges, OfAnEmptyPolytopeAreNone) {
  EXPECT_TRUE(edges(closed_mesh(Polytope{})).empty());
}

TEST(ConvexHull, HoldsEveryPointAndTurnsLeftOnly) {
  Random random(9);
  for (int k = 0; k < 100; ++k) {
    std::vector<Eigen::Vector2d> points;
    for (int i = 3 + random.below(40); i > 0; --i) {
      points.emplace_back(random.below(12), random.below(12));  // with repeats and straight rows
    }
    const auto hull = convex_hull(points);
    if (hull.size() < 3) continue;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d a = hull[i], edge = hull[(i + 1) % hull.size()] - a;
      for (const auto& p : points) {
        EXPECT_GE(edge.x() * (p - a).y() - edge.y() * (p - a).x(), 0.0);
      }
    }
  }
}

TEST(ConvexHull, OfFewOrAlignedPointsIsNoPolygon) {
  EXPECT_TRUE(convex_hull({}).empty());
  EXPECT_EQ(convex_hull({{1, 1}}).size(), 1U);
  EXPECT_LT(convex_hull({{1, 1}, {1, 1}, {1, 1}}).size(), 3U);
  EXPECT_LT(convex_hull({{0, 0}, {1, 1}, {2, 2}, {5, 5}}).size(), 3U);
}

}  // namespace
}  // namespace goshawk::visualization
