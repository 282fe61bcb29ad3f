#include "goshawk/core/polytope.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 random_unit(Random& random) {
  for (;;) {
    const Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
  }
}

Polytope random_polytope(int extra_faces, double depth, Random& random) {
  const Vec3 center(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(0, 5));
  const Vec3 half(random.uniform(0.5, 4), random.uniform(0.5, 4), random.uniform(0.5, 4));
  Polytope polytope = Polytope::box(center - half, center + half);
  for (int i = 0; i < extra_faces; ++i) {
    const Vec3 normal = random_unit(random);
    polytope.add(normal, normal.dot(center) + random.uniform(-depth, 2.0));
  }
  return polytope;
}

Polytope both(const Polytope& a, const Polytope& b) {
  Polytope joined = a;
  for (const HalfSpace& face : b.half_spaces) joined.half_spaces.push_back(face);
  return joined;
}

double room(const Polytope& polytope, const Vec3& p) {
  return -polytope.violation(p);
}

// The largest radius, from the definition: the linear programme's optimum is at a vertex, so try
// every four constraints and keep the best feasible intersection. Bounded polytopes only.
double brute_force_radius(const Polytope& polytope) {
  double best = -kInfinity;
  const int m = polytope.faces();
  for (int i = 0; i < m; ++i) {
    for (int j = i + 1; j < m; ++j) {
      for (int k = j + 1; k < m; ++k) {
        for (int l = k + 1; l < m; ++l) {
          Eigen::Matrix4d rows;
          Eigen::Vector4d bounds;
          int n = 0;
          for (const int face : {i, j, k, l}) {
            rows.row(n) << polytope.A().row(face), 1.0;
            bounds[n++] = polytope.b()[face];
          }
          if (std::abs(rows.determinant()) < 1e-9) continue;
          const Eigen::Vector4d x = rows.partialPivLu().solve(bounds);
          if (x[3] > best && room(polytope, x.head<3>()) > x[3] - 1e-7) best = x[3];
        }
      }
    }
  }
  return best;
}

TEST(Polytope, MeasuresTheDistanceToItsFaces) {
  const Polytope box = Polytope::box(Vec3(0, 0, 0), Vec3(2, 4, 6));
  EXPECT_TRUE(box.check().ok());
  EXPECT_EQ(box.faces(), 6);
  EXPECT_DOUBLE_EQ(box.violation(Vec3(1, 2, 3)), -1.0);
  EXPECT_DOUBLE_EQ(box.violation(Vec3(1.5, 2, 3)), -0.5);
  EXPECT_DOUBLE_EQ(box.violation(Vec3(2, 2, 3)), 0.0);
  EXPECT_DOUBLE_EQ(box.violation(Vec3(1, 2, -0.25)), 0.25);
}

TEST(Polytope, AddsFacesOneByOne) {
  Polytope polytope;
  for (int i = 0; i < 3; ++i) polytope.add(Vec3::Unit(i), 1.0 + i);
  EXPECT_EQ(polytope.faces(), 3);
  EXPECT_TRUE(polytope.check().ok());
  EXPECT_DOUBLE_EQ(polytope.violation(Vec3(0, 0, 3.5)), 0.5);
}

TEST(Polytope, ViolationOfNaNIsNaNWhereverItStands) {
  for (int face = 0; face < 6; ++face) {
    Polytope polytope = Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1));
    polytope.half_spaces[std::size_t(face)].offset_m = NAN;
    EXPECT_TRUE(std::isnan(polytope.violation(Vec3(0.5, 0.5, 0.5)))) << face;
    EXPECT_TRUE(std::isnan(polytope.violation(Vec3(9, 9, 9)))) << face;
    polytope = Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1));
    polytope.half_spaces[std::size_t(face)].normal[face % 3] = NAN;
    EXPECT_TRUE(std::isnan(polytope.violation(Vec3(0.5, 0.5, 0.5)))) << face;
  }
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 p(0.5, 0.5, 0.5);
    p[axis] = NAN;
    EXPECT_TRUE(std::isnan(Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1)).violation(p)));
  }
}

TEST(Polytope, CheckRefusesWhatIsNoPolytope) {
  EXPECT_EQ(Polytope().check().code(), ErrorCode::invalid_input);
  Polytope polytope = Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  polytope = Polytope::box(Vec3(0, 0, 0), Vec3(1, NAN, 1));
  EXPECT_EQ(polytope.check().code(), ErrorCode::invalid_input);
  polytope = Polytope::box(Vec3(0, 0, 0), Vec3(1, kInfinity, 1));
  EXPECT_EQ(polytope.check().code(), ErrorCode::invalid_input);
  polytope = Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  polytope.add(Vec3(0, 0, 2), 1.0);
  EXPECT_EQ(polytope.check().code(), ErrorCode::invalid_input);
}

TEST(Polytope, ShowsItsFacesAsAMatrixAndAVector) {
  Random random(9);
  const Polytope polytope = random_polytope(5, 1.0, random);
  ASSERT_EQ(polytope.A().rows(), 11);
  ASSERT_EQ(polytope.b().size(), 11);
  for (int i = 0; i < 11; ++i) {
    EXPECT_EQ(Vec3(polytope.A().row(i)), polytope.half_spaces[std::size_t(i)].normal);
    EXPECT_EQ(polytope.b()[i], polytope.half_spaces[std::size_t(i)].offset_m);
  }
  for (int n = 0; n < 100; ++n) {
    const Vec3 p(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-5, 9));
    EXPECT_NEAR((polytope.A() * p - polytope.b()).maxCoeff(), polytope.violation(p), 1e-12);
  }
  EXPECT_EQ(Polytope().A().rows(), 0);
  EXPECT_EQ(Polytope().b().size(), 0);
}

TEST(Polytope, HoldsAlwaysOrInAnIntervalThatEndsAfterItBegins) {
  Polytope polytope = Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  EXPECT_TRUE(polytope.always_valid());
  const auto check = [&](double from_s, double until_s) {
    polytope.valid_from_s = from_s;
    polytope.valid_until_s = until_s;
    EXPECT_FALSE(polytope.always_valid());
    return polytope.check().code();
  };
  EXPECT_EQ(check(0.0, 2.5), ErrorCode::ok);
  EXPECT_EQ(check(-1.0, 0.0), ErrorCode::ok);
  for (const auto& [from_s, until_s] : {std::pair{2.0, 1.0}, {1.0, 1.0}, {1.0, 0.0}}) {
    EXPECT_EQ(check(from_s, until_s), ErrorCode::invalid_input) << from_s << " to " << until_s;
  }
  for (const double bad : {double(NAN), kInfinity, -kInfinity}) {
    EXPECT_EQ(check(bad, 1.0), ErrorCode::invalid_input);
    EXPECT_EQ(check(0.0, bad), ErrorCode::invalid_input);
  }
}

TEST(HalfSpace, MeasuresTheDistanceToItsPlane) {
  const HalfSpace face{Vec3(0, 0.6, 0.8), 2.0};
  EXPECT_DOUBLE_EQ(face.distance_m(Vec3::Zero()), -2.0);
  EXPECT_DOUBLE_EQ(face.distance_m(3.0 * face.normal), 1.0);
  EXPECT_DOUBLE_EQ(face.distance_m(3.0 * face.normal + Vec3(5, 0, 0)), 1.0);
  EXPECT_TRUE(std::isnan(face.distance_m(Vec3(0, NAN, 0))));
  EXPECT_TRUE(face.is_finite());
  EXPECT_FALSE((HalfSpace{Vec3(0, NAN, 1), 0.0}.is_finite()));
  EXPECT_FALSE((HalfSpace{Vec3(0, 0, 1), kInfinity}.is_finite()));
}

TEST(ChebyshevBall, OfABoxHasHalfItsLeastEdge) {
  const Ball ball = chebyshev_ball(Polytope::box(Vec3(-1, 2, 3), Vec3(1, 8, 13)));
  EXPECT_NEAR(ball.radius_m, 1.0, 1e-9);
  EXPECT_NEAR(ball.center_map.x(), 0.0, 1e-9);
  const Ball cube = chebyshev_ball(Polytope::box(Vec3(0, 0, 0), Vec3(3, 3, 3)));
  EXPECT_NEAR(cube.radius_m, 1.5, 1e-9);
  EXPECT_LT((cube.center_map - Vec3::Constant(1.5)).norm(), 1e-9);
}

TEST(ChebyshevBall, IsInsideAndLargestOnRandomPolytopes) {
  Random random(1);
  int empty = 0;
  for (int n = 0; n < 400; ++n) {
    const Polytope polytope = random_polytope(random.below(7), n % 2 == 0 ? -0.1 : 1.5, random);
    const Ball ball = chebyshev_ball(polytope);
    ASSERT_GE(room(polytope, ball.center_map), ball.radius_m - 1e-12);
    ASSERT_NEAR(ball.radius_m, brute_force_radius(polytope), 1e-7) << "polytope " << n;
    empty += ball.radius_m < 0.0 ? 1 : 0;
  }
  EXPECT_GT(empty, 10) << "polytopes without a common point belong to the sample";
}

TEST(ChebyshevBall, IsInsideAndLargestForTwoOverlappingPolytopes) {
  Random random(2);
  for (int n = 0; n < 150; ++n) {
    const Polytope a = random_polytope(random.below(3), -0.1, random);
    Polytope b = random_polytope(random.below(3), -0.1, random);
    // Moved near the first, so that some overlap and some do not.
    const Vec3 shift = chebyshev_ball(a).center_map - chebyshev_ball(b).center_map +
                       random.uniform(0.0, 4.0) * random_unit(random);
    for (HalfSpace& face : b.half_spaces) face.offset_m += face.normal.dot(shift);
    const Ball ball = chebyshev_ball(a, b);
    ASSERT_GE(std::min(room(a, ball.center_map), room(b, ball.center_map)), ball.radius_m - 1e-12);
    ASSERT_NEAR(ball.radius_m, brute_force_radius(both(a, b)), 1e-7) << "pair " << n;
    ASSERT_NEAR(ball.radius_m, chebyshev_ball(b, a).radius_m, 1e-9);
  }
}

TEST(ChebyshevBall, FindsTheSphereThatManyFacesTouch) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const Vec3 center(random.uniform(-100, 100), random.uniform(-100, 100), random.uniform(0, 9));
    const double radius = std::pow(10.0, random.uniform(-3.0, 2.0));
    Polytope polytope =
        Polytope::box(center - Vec3::Constant(radius), center + Vec3::Constant(radius));
    const int faces = random.below(200);
    for (int i = 0; i < faces; ++i) {
      const Vec3 normal = random_unit(random);
      polytope.add(normal, normal.dot(center) + radius);
    }
    const Ball ball = chebyshev_ball(polytope);
    ASSERT_NEAR(ball.radius_m, radius, 1e-9 * (1.0 + radius));
    ASSERT_LT((ball.center_map - center).norm(), 1e-6 * (1.0 + radius));
  }
}

TEST(ChebyshevBall, StandsRepeatedAndAlmostParallelFaces) {
  Random random(4);
  for (int n = 0; n < 300; ++n) {
    Polytope polytope = Polytope::box(Vec3(0, 0, 0), Vec3(4, 4, 2));
    for (int i = 0; i < 30; ++i) {
      const int face = random.below(6);
      const double tilt = std::pow(10.0, -random.uniform(3.0, 16.0));
      const Vec3 normal =
          (polytope.half_spaces[std::size_t(face)].normal + tilt * random_unit(random))
              .normalized();
      polytope.add(normal, normal.dot(Vec3(2, 2, 1)) + (face % 3 == 2 ? 1.0 : 2.0));
    }
    const Ball ball = chebyshev_ball(polytope);
    ASSERT_GE(room(polytope, ball.center_map), ball.radius_m - 1e-12);
    ASSERT_NEAR(ball.radius_m, 1.0, 1e-9);
  }
}

TEST(ChebyshevBall, TellsByHowMuchAnEmptyPolytopeMisses) {
  Polytope gap = Polytope::box(Vec3(0, 0, 0), Vec3(4, 4, 4));
  gap.half_spaces[0].offset_m = 1.0;  // x <= 1 and x >= 3: a gap of 2
  gap.half_spaces[3].offset_m = -3.0;
  const Ball ball = chebyshev_ball(gap);
  EXPECT_NEAR(ball.radius_m, -1.0, 1e-9);
  EXPECT_NEAR(ball.center_map.x(), 2.0, 1e-9);
  const Ball apart = chebyshev_ball(Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1)),
                                    Polytope::box(Vec3(3, 0, 0), Vec3(4, 1, 1)));
  EXPECT_NEAR(apart.radius_m, -1.0, 1e-9);
}

TEST(ChebyshevBall, OfTouchingBoxesIsAPoint) {
  const Ball ball = chebyshev_ball(Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1)),
                                   Polytope::box(Vec3(1, 0, 0), Vec3(2, 1, 1)));
  EXPECT_NEAR(ball.radius_m, 0.0, 1e-9);
  EXPECT_NEAR(ball.center_map.x(), 1.0, 1e-9);
}

TEST(ChebyshevBall, OfAnUnboundedPolytopeIsHugeAndInside) {
  Polytope half_space;
  half_space.add(Vec3(0, 0, 1), 3.0);
  const Ball ball = chebyshev_ball(half_space);
  EXPECT_GT(ball.radius_m, 1e5);
  EXPECT_TRUE(std::isfinite(ball.radius_m));
  EXPECT_GE(room(half_space, ball.center_map), ball.radius_m - 1e-12);
  EXPECT_GT(chebyshev_ball(Polytope()).radius_m, 1e5);
  Polytope slab;  // unbounded along x and y, yet its ball is bounded
  slab.add(Vec3(0, 0, 1), 3.0);
  slab.add(Vec3(0, 0, -1), -1.0);
  EXPECT_NEAR(chebyshev_ball(slab).radius_m, 1.0, 1e-6);
}

TEST(ChebyshevBall, OfWhatIsNotFiniteHoldsNothing) {
  for (const double bad : {double(NAN), kInfinity, -kInfinity}) {
    for (int face = 0; face < 6; ++face) {
      Polytope polytope = Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1));
      polytope.half_spaces[std::size_t(face)].offset_m = bad;
      EXPECT_EQ(chebyshev_ball(polytope).radius_m, -kInfinity);
      polytope.half_spaces[std::size_t(face)].offset_m = 1.0;
      polytope.half_spaces[std::size_t(face)].normal[0] = bad;
      EXPECT_EQ(chebyshev_ball(polytope).radius_m, -kInfinity);
      EXPECT_EQ(chebyshev_ball(Polytope::box(Vec3(0, 0, 0), Vec3(1, 1, 1)), polytope).radius_m,
                -kInfinity);
    }
  }
}

Corridor two_boxes() {
  Corridor corridor;
  corridor.waypoints_map = {Vec3(0.5, 0.5, 0.5), Vec3(1.5, 0.5, 0.5), Vec3(2.5, 0.5, 0.5)};
  corridor.polytopes = {Polytope::box(Vec3(0, 0, 0), Vec3(2, 1, 1)),
                        Polytope::box(Vec3(1, 0, 0), Vec3(3, 1, 1))};
  corridor.overlaps = {chebyshev_ball(corridor.polytopes[0], corridor.polytopes[1])};
  return corridor;
}

TEST(Corridor, ChecksItsSizesAndItsWaypoints) {
  EXPECT_TRUE(two_boxes().check().ok());
  EXPECT_NEAR(two_boxes().min_overlap_radius_m(), 0.5, 1e-9);
  EXPECT_EQ(Corridor{}.check().code(), ErrorCode::invalid_input);
  Corridor corridor = two_boxes();
  corridor.waypoints_map.pop_back();
  EXPECT_EQ(corridor.check().code(), ErrorCode::invalid_input);
  corridor = two_boxes();
  corridor.overlaps.clear();
  EXPECT_EQ(corridor.check().code(), ErrorCode::invalid_input);
  corridor = two_boxes();
  corridor.polytopes[1].half_spaces[2].normal[1] = NAN;
  EXPECT_EQ(corridor.check().code(), ErrorCode::invalid_input);
  corridor = two_boxes();
  corridor.waypoints_map[1] = Vec3(0.5, 0.5, 0.5);  // in the first box only
  const auto outside = corridor.check();
  EXPECT_EQ(outside.code(), ErrorCode::invalid_input);
  EXPECT_NE(outside.error().message.find("waypoint 1"), std::string::npos);
  corridor.waypoints_map[1] = Vec3(NAN, 0.5, 0.5);
  EXPECT_EQ(corridor.check().code(), ErrorCode::invalid_input);
}

TEST(Corridor, DoesNotLoseAnOverlapThatIsNaN) {
  Corridor corridor = two_boxes();
  corridor.overlaps[0].radius_m = NAN;
  EXPECT_TRUE(std::isnan(corridor.min_overlap_radius_m()));
  EXPECT_EQ(corridor.check().code(), ErrorCode::invalid_input);
  corridor.overlaps = {};
  EXPECT_EQ(corridor.min_overlap_radius_m(), kInfinity);
}

}  // namespace
}  // namespace goshawk
