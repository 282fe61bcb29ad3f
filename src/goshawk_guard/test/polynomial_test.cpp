#include <gmock/gmock.h>

#include "goshawk/core/random.hpp"
#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {
namespace {

using testing::HasSubstr;

double value_at(const std::vector<double>& coefficients, double t) {
  double value = 0.0;
  for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) value = value * t + *c;
  return value;
}

Vec3 value_at(const Polynomials::Piece& piece, double t) {
  return {value_at(piece.coefficients[0], t), value_at(piece.coefficients[1], t),
          value_at(piece.coefficients[2], t)};
}

Polynomials::Piece made_piece(Random& random, int degree, double duration_s) {
  Polynomials::Piece piece{.duration_s = duration_s};
  for (auto& coefficients : piece.coefficients) {
    double scale = 1.0;
    for (int j = 0; j <= degree; ++j) {
      coefficients.push_back(scale * random.uniform(-2, 2));
      scale /= duration_s;
    }
  }
  return piece;
}

TEST(PolynomialCurve, IsThePolynomialUpToTheFifthDegree) {
  Random random(1);
  for (int degree = 0; degree <= 5; ++degree) {
    const Polynomials p{{made_piece(random, degree, 0.7), made_piece(random, degree, 3.0)}};
    const auto curve = curve_of(p);
    ASSERT_TRUE(curve) << curve.error().message;
    ASSERT_EQ(curve->trajectory.pieces.size(), 2u);
    EXPECT_EQ(curve->deviation_m, 0.0);
    for (std::size_t k = 0; k < 2; ++k) {
      const double duration = p.pieces[k].duration_s;
      for (int i = 0; i <= 20; ++i) {
        const double t = duration * i / 20;
        const Vec3 off = curve->trajectory.pieces[k].sample(t).position - value_at(p.pieces[k], t);
        EXPECT_LT(off.norm(), 1e-9);
      }
    }
  }
}

TEST(PolynomialCurve, OfHigherDegreeIsAsNearAsItSays) {
  Random random(2);
  for (int degree = 6; degree <= 9; ++degree) {
    const Polynomials p{{made_piece(random, degree, 2.0)}};
    const auto curve = curve_of(p);
    ASSERT_TRUE(curve) << curve.error().message;
    EXPECT_LE(curve->deviation_m, kPolynomialWithin_m);
    EXPECT_NEAR(curve->trajectory.duration_s(), 2.0, 1e-12);
    double farthest_m = 0.0;
    for (int i = 0; i <= 5000; ++i) {
      const double t = 2.0 * i / 5000;
      const Vec3 off = curve->trajectory.sample(t).position - value_at(p.pieces[0], t);
      farthest_m = std::max(farthest_m, off.norm());
    }
    EXPECT_LE(farthest_m, curve->deviation_m + 1e-9);
    EXPECT_GT(farthest_m, 0.0);
    const auto& pieces = curve->trajectory.pieces;
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
      EXPECT_LT(largest_difference(pieces[k].sample(pieces[k].duration_s), pieces[k + 1].sample(0)),
                1e-6);
    }
  }
}

TEST(PolynomialCurve, IsRefusedWithTheReasonIfItIsNone) {
  Random random(3);
  const Polynomials good{{made_piece(random, 5, 1.0), made_piece(random, 3, 1.0)}};
  const auto refusal = [&](auto&& spoil) {
    Polynomials p = good;
    spoil(p);
    const auto curve = curve_of(p);
    EXPECT_EQ(curve.code(), ErrorCode::invalid_input);
    return curve ? std::string() : curve.error().message;
  };
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces.clear(); }), HasSubstr("0 polynomial pieces"));
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces.resize(5000); }), HasSubstr("5000"));
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces[1].duration_s = 0; }), HasSubstr("piece 1"));
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces[1].duration_s = -1; }), HasSubstr("piece 1"));
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces[0].duration_s = NAN; }), HasSubstr("piece 0"));
  // So short that the square of it is zero.
  EXPECT_THAT(refusal([](Polynomials& p) {
                p.pieces[1] = {.duration_s = 1e-200, .coefficients = {}};
                for (auto& c : p.pieces[1].coefficients) c.assign(10, 1.0);
              }),
              HasSubstr("piece 1 lasts 1e-200 s"));
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces[0].coefficients[1].clear(); }),
              HasSubstr("0 coefficients"));
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces[0].coefficients[1].resize(11); }),
              HasSubstr("11 coefficients"));
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces[0].coefficients[2][3] = INFINITY; }),
              HasSubstr("not finite"));
  EXPECT_THAT(refusal([](Polynomials& p) { p.pieces[0].coefficients[2][3] = 1e9; }),
              HasSubstr("may leave"));
}

// Of so high an amplitude that no short quintic is within a millimetre.
TEST(PolynomialCurve, ThatNothingComesNearToIsRefused) {
  Polynomials p{{{.duration_s = 1.0, .coefficients = {{{0}, {0}, {0}}}}}};
  p.pieces[0].coefficients[0] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 9e5};
  const auto curve = curve_of(p);
  ASSERT_FALSE(curve);
  EXPECT_EQ(curve.code(), ErrorCode::trajectory_infeasible);
}

}  // namespace
}  // namespace goshawk::guard
