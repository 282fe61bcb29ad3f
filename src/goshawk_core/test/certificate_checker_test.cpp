// Two implementations that share nothing must say the same: measure() and the one-header checker.
#include "goshawk/certificate_checker.hpp"

#include <gtest/gtest.h>

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

Vec3 any_vector(Random& random, double size) {
  return Vec3(random.uniform(-size, size), random.uniform(-size, size),
              random.uniform(-size, size));
}

FlatState random_state(Random& random) {
  return {any_vector(random, 3.0), any_vector(random, 2.0), any_vector(random, 2.0), {}};
}

struct Case {
  Trajectory trajectory;
  std::vector<Polytope> polytopes;
  Limits limits;
  FlatState start, goal;
};

Case random_case(Random& random) {
  Case c;
  FlatState at = c.start = random_state(random);
  const int pieces = 1 + random.below(6);
  for (int k = 0; k < pieces; ++k) {
    const FlatState next = random_state(random);
    c.trajectory.pieces.push_back(BezierPiece::between(at, next, random.uniform(0.2, 2.0)));
    c.trajectory.pieces.back().polytope = random.below(2);
    at = next;
    if (random.chance(0.2)) at.velocity.x() += random.uniform(-1e-5, 1e-5);
  }
  c.goal = at;
  for (int i = 0; i < 2; ++i) {
    c.polytopes.push_back(Polytope::box(any_vector(random, 1.0) - Vec3(6, 6, 6),
                                        any_vector(random, 1.0) + Vec3(6, 6, 6)));
    c.polytopes.back().add(any_vector(random, 1.0).normalized(), random.uniform(2.0, 8.0));
    if (random.chance(0.3)) {
      c.polytopes.back().valid_from_s = random.uniform(-1.0, 1.0);
      c.polytopes.back().valid_until_s = random.uniform(1.0, 12.0);
    }
  }
  c.limits = {.v_max_m_s = random.uniform(1.0, 30.0),
              .a_max_m_s2 = random.uniform(1.0, 200.0),
              .norm = LimitNorm(random.below(3)),
              .j_max_m_s3 = random.chance(0.5) ? random.uniform(1.0, 2000.0) : 0.0,
              .v_max_vertical_m_s = random.chance(0.5) ? random.uniform(1.0, 30.0) : 0.0,
              .a_max_vertical_m_s2 = random.chance(0.5) ? random.uniform(1.0, 200.0) : 0.0};
  return c;
}

goshawk_checker::Point plain(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
goshawk_checker::State plain(const FlatState& s) {
  return {plain(s.position), plain(s.velocity), plain(s.acceleration)};
}

goshawk_checker::Verdict second_opinion(const Case& c) {
  std::vector<goshawk_checker::Piece> pieces;
  for (const BezierPiece& p : c.trajectory.pieces) {
    auto& piece = pieces.emplace_back();
    piece.duration = p.duration_s;
    piece.polytope = std::size_t(p.polytope);
    for (int j = 0; j < 6; ++j) {
      piece.control_points[std::size_t(j)] = plain(Vec3(p.control_points.col(j)));
    }
  }
  std::vector<goshawk_checker::Polytope> polytopes;
  for (const Polytope& p : c.polytopes) {
    auto& polytope = polytopes.emplace_back();
    for (const HalfSpace& face : p.half_spaces) {
      polytope.normals.insert(polytope.normals.end(), face.normal.begin(), face.normal.end());
      polytope.offsets.push_back(face.offset_m);
    }
    polytope.valid_from = p.valid_from_s;
    polytope.valid_until = p.valid_until_s;
  }
  const Limits& l = c.limits;
  return goshawk_checker::check(pieces, polytopes,
                                {l.v_max_m_s, l.a_max_m_s2, int(l.norm), l.j_max_m_s3,
                                 l.v_max_vertical_m_s, l.a_max_vertical_m_s2},
                                plain(c.start), plain(c.goal));
}

TEST(CertificateChecker, AgreesWithMeasureInEveryFamily) {
  Random random(17);
  int held = 0;
  int braked = 0;
  for (int i = 0; i < 3000; ++i) {
    SCOPED_TRACE(i);
    const Case c = random_case(random);
    const Certificate a = measure(c.trajectory, c.polytopes, c.limits, c.start, c.goal);
    const auto b = second_opinion(c);
    const auto near = [](double x, double y) { EXPECT_NEAR(x, y, 1e-9 * (1.0 + std::abs(x))); };
    near(a.position_m, b.position);
    near(a.velocity_m_s, b.velocity);
    near(a.acceleration_m_s2, b.acceleration);
    near(a.jerk_m_s3, b.jerk);
    near(a.validity_s, b.validity);
    near(a.continuity_position_m, b.continuity_position);
    near(a.continuity_velocity_m_s, b.continuity_velocity);
    near(a.continuity_acceleration_m_s2, b.continuity_acceleration);
    near(a.start_m, b.start);
    near(a.goal_m, b.goal);
    EXPECT_EQ(a.holds(), b.holds());
    held += a.holds() ? 1 : 0;
    braked += StartAllowance::of(c.start, c.limits).until_s > 0.0 ? 1 : 0;
  }
  EXPECT_GT(held, 20);
  EXPECT_GT(braked, 20);
}

TEST(CertificateChecker, NonsenseDoesNotHold) {
  Random random(2);
  const auto bad = [&](auto&& spoil) {
    Case c = random_case(random);
    c.limits = {.v_max_m_s = 1e3, .a_max_m_s2 = 1e5};
    for (Polytope& p : c.polytopes) p = Polytope::box(Vec3(-99, -99, -99), Vec3(99, 99, 99));
    c.goal = c.trajectory.pieces.back().sample(c.trajectory.pieces.back().duration_s);
    spoil(c);
    return !second_opinion(c).holds(1e-4);
  };
  EXPECT_FALSE(bad([](Case&) {}));
  EXPECT_TRUE(bad([](Case& c) { c.trajectory.pieces.clear(); }));
  EXPECT_TRUE(bad([](Case& c) { c.trajectory.pieces[0].duration_s = 0.0; }));
  EXPECT_TRUE(bad([](Case& c) { c.trajectory.pieces[0].duration_s = NAN; }));
  EXPECT_TRUE(bad([](Case& c) { c.trajectory.pieces[0].polytope = 7; }));
  EXPECT_TRUE(bad([](Case& c) { c.trajectory.pieces[0].control_points(1, 2) = NAN; }));
  EXPECT_TRUE(bad([](Case& c) { c.polytopes[0] = c.polytopes[1] = {}; }));
  EXPECT_TRUE(bad([](Case& c) {
    for (Polytope& p : c.polytopes) p.half_spaces[0].normal[0] = NAN;
  }));
  EXPECT_TRUE(bad([](Case& c) { c.limits.v_max_m_s = -1.0; }));
  EXPECT_TRUE(bad([](Case& c) { c.goal.position.x() += 0.1; }));
}

}  // namespace
}  // namespace goshawk
