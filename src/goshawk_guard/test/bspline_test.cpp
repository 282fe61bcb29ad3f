#include <gmock/gmock.h>

#include "goshawk/core/random.hpp"
#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {
namespace {

using testing::HasSubstr;

// The basis function by its definition (Cox and de Boor), apart from how curve_of() works.
double basis(const std::vector<double>& knots, std::size_t i, int degree, double t) {
  if (degree == 0) return knots[i] <= t && t < knots[i + 1] ? 1.0 : 0.0;
  const auto ratio = [](double above, double below) { return below > 0.0 ? above / below : 0.0; };
  const auto d = std::size_t(degree);
  return ratio(t - knots[i], knots[i + d] - knots[i]) * basis(knots, i, degree - 1, t) +
         ratio(knots[i + d + 1] - t, knots[i + d + 1] - knots[i + 1]) *
             basis(knots, i + 1, degree - 1, t);
}

Vec3 point_on(const Bspline& s, double t) {
  Vec3 p = Vec3::Zero();
  for (std::size_t i = 0; i < s.control_points_map.size(); ++i) {
    p += basis(s.knots_s, i, s.degree, t) * s.control_points_map[i];
  }
  return p;
}

Bspline made(Random& random, int degree, std::size_t points, bool uniform) {
  Bspline s{.degree = degree};
  for (std::size_t i = 0; i < points; ++i) {
    s.control_points_map.emplace_back(random.uniform(-5, 5), random.uniform(-5, 5),
                                      random.uniform(0, 3));
  }
  double knot = -0.3;
  for (std::size_t i = 0; i < points + std::size_t(degree) + 1; ++i) {
    s.knots_s.push_back(knot);
    knot += uniform ? 0.15 : random.uniform(0.05, 0.4);
  }
  return s;
}

TEST(BsplineCurve, IsTheSplineAtAllTimes) {
  Random random(1);
  for (int round = 0; round < 40; ++round) {
    const int degree = 2 + round % 4;
    const Bspline s = made(random, degree, std::size_t(degree + 1 + round % 9), round % 2 == 0);
    const auto curve = curve_of(s);
    ASSERT_TRUE(curve) << curve.error().message;
    EXPECT_EQ(curve->deviation_m, 0.0);
    const double begin = s.knots_s[std::size_t(degree)];
    const double duration = s.knots_s[s.control_points_map.size()] - begin;
    EXPECT_NEAR(curve->trajectory.duration_s(), duration, 1e-12);
    for (int i = 0; i < 50; ++i) {
      const double t = duration * i / 50;
      EXPECT_LT((curve->trajectory.sample(t).position - point_on(s, begin + t)).norm(), 1e-9);
    }
  }
}

TEST(BsplineCurve, OfCubicsHasNoJumpInAcceleration) {
  Random random(2);
  const auto curve = curve_of(made(random, 3, 20, true)).value();
  const auto& pieces = curve.trajectory.pieces;
  ASSERT_EQ(pieces.size(), 17u);
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    EXPECT_LT(largest_difference(pieces[k].sample(pieces[k].duration_s), pieces[k + 1].sample(0)),
              1e-9);
  }
}

TEST(BsplineCurve, SkipsSpansThatLastNoTime) {
  Bspline s{
      .degree = 3,
      .knots_s = {0, 0, 0, 0, 1, 1, 2, 2, 2, 2},
      .control_points_map = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {3, 1, 1}, {4, 1, 1}, {5, 1, 1}}};
  const auto curve = curve_of(s).value();
  ASSERT_EQ(curve.trajectory.pieces.size(), 2u);
  EXPECT_LT((curve.trajectory.sample(0.7).position - point_on(s, 0.7)).norm(), 1e-12);
  EXPECT_LT((curve.trajectory.sample(2.0).position - Vec3(5, 1, 1)).norm(), 1e-12);
}

TEST(BsplineCurve, TakesKnotsThatAreEqualUpToRoundingAsEqual) {
  Random random(4);
  Bspline s = made(random, 3, 8, true);
  s.knots_s[5] = s.knots_s[4];
  const auto equal = curve_of(s).value();
  s.knots_s[5] = s.knots_s[4] + 1e-13;
  const auto rounded = curve_of(s).value();
  ASSERT_EQ(rounded.trajectory.pieces.size(), equal.trajectory.pieces.size());
  for (std::size_t k = 0; k < equal.trajectory.pieces.size(); ++k) {
    const Points3<6> off =
        equal.trajectory.pieces[k].control_points - rounded.trajectory.pieces[k].control_points;
    EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(BsplineCurve, IsRefusedWithTheReasonIfItIsNone) {
  Random random(3);
  const Bspline good = made(random, 3, 8, true);
  const auto refusal = [&](auto&& spoil) {
    Bspline s = good;
    spoil(s);
    const auto curve = curve_of(s);
    EXPECT_EQ(curve.code(), ErrorCode::invalid_input);
    return curve ? std::string() : curve.error().message;
  };
  EXPECT_THAT(refusal([](Bspline& s) { s.degree = 1; }), HasSubstr("degree 1"));
  EXPECT_THAT(refusal([](Bspline& s) { s.degree = 6; }), HasSubstr("degree 6"));
  EXPECT_THAT(refusal([](Bspline& s) { s.knots_s.pop_back(); }), HasSubstr("11 knots"));
  EXPECT_THAT(refusal([](Bspline& s) { s.control_points_map.clear(); }), HasSubstr("0 control"));
  EXPECT_THAT(refusal([](Bspline& s) { s.knots_s[4] = NAN; }), HasSubstr("not finite: knot 4"));
  EXPECT_THAT(refusal([](Bspline& s) { s.knots_s[5] = -9; }), HasSubstr("at knot 5"));
  EXPECT_THAT(refusal([](Bspline& s) { s.knots_s[5] = s.knots_s[4] + 1e-5; }),
              HasSubstr("knots 4 and 5 that are 1e-05 s apart"));
  EXPECT_THAT(refusal([](Bspline& s) { s.control_points_map[2].y() = NAN; }),
              HasSubstr("control point 2"));
  EXPECT_THAT(refusal([](Bspline& s) { s.control_points_map[2].y() = 1e9; }),
              HasSubstr("control point 2"));
  EXPECT_THAT(refusal([](Bspline& s) { s.knots_s.assign(s.knots_s.size(), 1.0); }),
              HasSubstr("lasts no time"));
  EXPECT_THAT(refusal([](Bspline& s) { s.control_points_map.resize(10'000, Vec3::Zero()); }),
              HasSubstr("10000 control points"));
}

}  // namespace
}  // namespace goshawk::guard
