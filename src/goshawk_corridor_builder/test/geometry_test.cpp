// The parts of the builder, each against a truth that is found in another way.

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "../src/ellipsoid.hpp"
#include "../src/inscribed_ellipsoid.hpp"
#include "../src/obstacle_boxes.hpp"
#include "../src/redundancy.hpp"
#include "../src/separating_plane.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::corridor_builder {
namespace {

Vec3 random_point(Random& random, double lo, double hi) {
  const double x = random.uniform(lo, hi);
  const double y = random.uniform(lo, hi);
  return {x, y, random.uniform(lo, hi)};
}

struct RandomBox {
  Vec3 lower, upper;
  explicit RandomBox(Random& random) : lower(random_point(random, -10, 10)) {
    upper = lower + random_point(random, 0.5, 8.0);
  }
};

TEST(ObstacleMerger, CoversEveryBlockedVoxelAndNoFreeOne) {
  Random random(1);
  ObstacleMerger merger;
  BoxSet boxes;
  for (int k = 0; k < 200; ++k) {
    const Index3 size{1 + random.below(200), 1 + random.below(12), 1 + random.below(8)};
    BitGrid grid(size, true);
    const double ratio = random.uniform();
    const bool upright = random.chance(0.5);  // layers repeat
    for (int z = 0; z < size.z; ++z) {
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          const bool copy = upright && z > 0 && !random.chance(0.001);
          grid.set({x, y, z}, copy ? grid.get({x, y, z - 1}) : random.chance(ratio));
        }
      }
    }
    VoxelBox region{{random.below(size.x), random.below(size.y), random.below(size.z)}, size};
    region.hi.x = region.lo.x + 1 + random.below(size.x - region.lo.x);
    region.hi.y = region.lo.y + 1 + random.below(size.y - region.lo.y);
    boxes.clear();
    merger.collect({&grid, nullptr}, region, region.lo, 0.0, boxes);
    BitGrid covered(size, true);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (int z = int(boxes.lo[2][i]); z < int(boxes.hi[2][i]); ++z) {
        for (int y = int(boxes.lo[1][i]); y < int(boxes.hi[1][i]); ++y) {
          for (int x = int(boxes.lo[0][i]); x < int(boxes.hi[0][i]); ++x) {
            const Index3 at = region.lo + Index3{x, y, z};
            ASSERT_TRUE(grid.get(at));
            covered.set(at, true);
          }
        }
      }
    }
    std::int64_t expected = 0;
    for (int z = region.lo.z; z < region.hi.z; ++z) {
      for (int y = region.lo.y; y < region.hi.y; ++y) {
        for (int x = region.lo.x; x < region.hi.x; ++x) expected += grid.get({x, y, z});
      }
    }
    ASSERT_EQ(covered.count(), expected);
  }
}

Mat3 random_metric(Random& random) {
  Mat3 l;
  for (int i = 0; i < 9; ++i) l(i / 3, i % 3) = random.uniform(-1, 1);
  const Vec3 axes(std::pow(10, random.uniform(-2, 1)), std::pow(10, random.uniform(-2, 1)), 1.0);
  const Mat3 w = axes.asDiagonal() * l;
  return w.transpose() * w + 1e-4 * Mat3::Identity();
}

TEST(Ellipsoid, NearestPointOfABoxIsNoFartherThanAnyOther) {
  Random random(2);
  for (int k = 0; k < 2000; ++k) {
    const Ellipsoid e{random_point(random, -10, 10), random_metric(random)};
    const RandomBox box(random);
    const Nearest nearest = nearest_in_box(e, box.lower, box.upper);
    const Vec3 p = e.center + nearest.offset;
    ASSERT_TRUE(((p - box.lower).array() > -1e-9).all() && ((box.upper - p).array() > -1e-9).all());
    // The objective is convex: no step towards any corner may lower it.
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Vec3 c((corner & 1U) ? box.upper.x() : box.lower.x(),
                   (corner & 2U) ? box.upper.y() : box.lower.y(),
                   (corner & 4U) ? box.upper.z() : box.lower.z());
      const double slope = (e.metric * nearest.offset).dot(c - p);
      ASSERT_GT(slope, -1e-7 * (1.0 + nearest.squared) * (e.metric.norm() + 1.0));
    }
  }
}

TEST(Ellipsoid, AroundASegmentEntersNoBoxAndHoldsTheSegment) {
  Random random(3);
  int shrunk = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3 p = random_point(random, -10, 10), q = random_point(random, -10, 10);
    BoxSet boxes;
    for (int i = 0; i < 12; ++i) {
      const RandomBox box(random);
      Plane plane;
      if (separate(Vec3::UnitX(), {box.lower, box.upper}, {p, q}, Margins{}, plane) !=
          Separation::blocked) {
        boxes.add(box.lower, box.upper);
      }
    }
    const Ellipsoid e = shrink_around_segment(p, q, boxes);
    EXPECT_NEAR((p - e.center).dot(e.metric * (p - e.center)), 1.0, 1e-6);
    EXPECT_NEAR((q - e.center).dot(e.metric * (q - e.center)), 1.0, 1e-6);
    const double volume = 1.0 / std::sqrt(e.metric.determinant());
    const double longest = 0.5 * (q - p).norm();
    shrunk += volume < 0.9 * longest * longest * longest;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const double squared = nearest_in_box(e, boxes.lower(i), boxes.upper(i)).squared;
      const bool at_shortest = e.metric.trace() > 1.0 / (0.051 * 0.051);
      EXPECT_TRUE(squared > 1.0 - 1e-6 || at_shortest) << squared;
    }
  }
  EXPECT_GT(shrunk, 100);
}

bool segment_enters(const Segment& s, const RandomBox& box) {  // by clipping the segment
  double from = 0.0, to = 1.0;
  const Vec3 d = s.q - s.p;
  for (int a = 0; a < 3; ++a) {
    double u = (box.lower[a] - s.p[a]) / d[a], v = (box.upper[a] - s.p[a]) / d[a];
    if (u > v) std::swap(u, v);
    from = std::max(from, u);
    to = std::min(to, v);
  }
  return from < to;
}

TEST(SeparatingPlane, KeepsBoxAndSegmentApartExactlyWhereThatIsPossible) {
  Random random(4);
  const Margins margins = Margins::for_coordinates(20.0);
  int apart = 0;
  for (int k = 0; k < 20000; ++k) {
    const double wanted = random.uniform(0.0, 1.0);
    const Segment s{random_point(random, -10, 10), random_point(random, -10, 10), {wanted, wanted}};
    const RandomBox box(random);
    const Obstacle obstacle{box.lower, box.upper};
    Plane plane;
    const Separation done = separate(random_point(random, -1, 1), obstacle, s, margins, plane);
    ASSERT_EQ(done != Separation::blocked, !segment_enters(s, box));
    if (done == Separation::blocked) continue;
    ++apart;
    EXPECT_NEAR(plane.normal.norm(), 1.0, 1e-12);
    EXPECT_GT(support(plane.normal, obstacle), plane.offset);
    EXPECT_GE(plane.slack(s.p), 0.0);
    EXPECT_GE(plane.slack(s.q), 0.0);
    const Vec3 x = s.p + nearest_parameter(obstacle, s) * (s.q - s.p);
    const double distance = (x.cwiseMax(box.lower).cwiseMin(box.upper) - x).norm();
    const double kept = std::min(plane.slack(s.p), plane.slack(s.q));
    EXPECT_GE(kept, (distance >= wanted ? wanted : 0.0) - 1e-6);
  }
  EXPECT_GT(apart, 5000);
}

// The distance between segment and box, by trying many points.
double sampled_clearance(const Segment& s, const Obstacle& o, const Room& room) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 2000; ++i) {
    const double t = i / 2000.0;
    const Vec3 x = s.p + t * (s.q - s.p);
    const double distance = (x.cwiseMax(o.lower).cwiseMin(o.upper) - x).norm();
    least = std::min(least, distance - o.radius - (1.0 - t) * room.p - t * room.q);
  }
  return least;
}

TEST(SeparatingPlane, LeavesTheBallsInFrontWhereTheirHullIsFree) {
  Random random(14);
  const Margins margins = Margins::for_coordinates(20.0);
  int roomy = 0, thin = 0;
  for (int k = 0; k < 4000; ++k) {
    const Room room{random.uniform(0.0, 2.0), random.uniform(0.0, 2.0)};
    const Segment s{random_point(random, -10, 10), random_point(random, -10, 10), room, room};
    const RandomBox box(random);
    const Obstacle obstacle{box.lower, box.upper,
                            random.chance(0.5) ? random.uniform(0.0, 2.0) : 0};
    const double truth = sampled_clearance(s, obstacle, room);
    const double found = clearance(obstacle, s, room);
    if (truth > 0.0) {
      ASSERT_NEAR(found, truth, 2e-2);
    } else {
      ASSERT_LT(found, 2e-2);
    }
    Plane plane;
    const Separation done = separate(random_point(random, -1, 1), obstacle, s, margins, plane);
    if (std::abs(truth) > 2e-2) {
      EXPECT_EQ(done == Separation::roomy, truth > 0.0);
    }
    roomy += done == Separation::roomy;
    thin += done == Separation::thin;
    if (done == Separation::blocked) continue;
    EXPECT_GT(support(plane.normal, obstacle), plane.offset);
    EXPECT_GE(plane.slack(s.p), done == Separation::roomy ? room.p - 1e-6 : 0.0);
    EXPECT_GE(plane.slack(s.q), done == Separation::roomy ? room.q - 1e-6 : 0.0);
  }
  EXPECT_GT(roomy, 1000);
  EXPECT_GT(thin, 100);
}

std::vector<Plane> random_polytope(Random& random, int planes, const Vec3& extent) {
  std::vector<Plane> all;
  for (int axis = 0; axis < 3; ++axis) {
    all.push_back({-Vec3::Unit(axis), 0.0, false});
    all.push_back({Vec3::Unit(axis), extent[axis], false});
  }
  for (int k = 0; k < planes; ++k) {
    const Vec3 n = random_point(random, -1, 1).normalized();
    all.push_back({n, n.dot(0.5 * extent) + random.uniform(0.5, 12.0), false});
  }
  return all;
}

bool all_hold(const std::vector<Plane>& planes, const Vec3& p, double tolerance) {
  for (const Plane& plane : planes) {
    if (plane.slack(p) < -tolerance) return false;
  }
  return true;
}

TEST(InscribedEllipsoid, StaysInsideAndFillsMuchOfABox) {
  Random random(5);
  for (int k = 0; k < 300; ++k) {
    const Vec3 extent = random_point(random, 4, 20);
    const auto planes = random_polytope(random, k % 20, extent);
    const Ellipsoid seed{0.5 * extent, Mat3::Identity() / 0.04};
    Ellipsoid grown;
    ASSERT_TRUE(grow_inscribed_ellipsoid(planes, seed, grown));
    const Mat3 shape = grown.metric.inverse();
    for (const Plane& plane : planes) {
      EXPECT_GE(plane.slack(grown.center),
                std::sqrt(plane.normal.dot(shape * plane.normal)) - 1e-9);
    }
    const double volume = std::sqrt(shape.determinant());
    if (k % 20 == 0) {
      EXPECT_GT(volume, 0.25 * (0.5 * extent).prod());
      EXPECT_LE(volume, (0.5 * extent).prod() * (1.0 + 1e-9));
    }
  }
}

TEST(InscribedEllipsoid, RefusesACentreOutside) {
  const auto planes = [] {
    Random random(6);
    return random_polytope(random, 0, Vec3(4, 4, 4));
  }();
  Ellipsoid grown;
  EXPECT_FALSE(grow_inscribed_ellipsoid(planes, {Vec3(5, 2, 2), Mat3::Identity()}, grown));
}

TEST(RedundancyFilter, KeepsThePolytopeAndLeavesOutWhatIsNoFace) {
  Random random(7);
  RedundancyFilter filter;
  std::vector<Plane> kept;
  const Margins margins;
  std::size_t left_out = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 extent = random_point(random, 4, 20);
    auto planes = random_polytope(random, random.below(40), extent);
    for (int copies = random.below(3); copies > 0; --copies) planes.push_back(planes.back());
    filter.filter(planes, extent, margins, kept);
    left_out += planes.size() - kept.size();
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = 1.4 * random_point(random, 0, 1).cwiseProduct(extent) - 0.2 * extent;
      ASSERT_TRUE(!all_hold(kept, p, 0.0) || all_hold(planes, p, margins.plane));
    }
  }
  EXPECT_GT(left_out, 1000U);
}

}  // namespace
}  // namespace goshawk::corridor_builder
