#include "goshawk/core/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

Vec3 random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

BezierPiece random_piece(Random& random) {
  BezierPiece piece;
  piece.duration_s = random.uniform(0.3, 3.0);
  for (int j = 0; j < 6; ++j) piece.control_points.col(j) = random_vector(random, 4.0);
  return piece;
}

Trajectory random_trajectory(int pieces, Random& random) {
  Trajectory trajectory;
  for (int k = 0; k < pieces; ++k) trajectory.pieces.push_back(random_piece(random));
  return trajectory;
}

// The definition: sum of Bernstein polynomials, in long double.
Vec3 bernstein_position(const BezierPiece& piece, double t_s) {
  const long double tau = static_cast<long double>(t_s) / piece.duration_s;
  const long double binomial[] = {1, 5, 10, 10, 5, 1};
  Vec3 sum;
  for (int axis = 0; axis < 3; ++axis) {
    long double value = 0.0L;
    for (int j = 0; j < 6; ++j) {
      value += binomial[j] * std::pow(tau, (long double)j) *
               std::pow(1.0L - tau, (long double)(5 - j)) * piece.control_points(axis, j);
    }
    sum[axis] = double(value);
  }
  return sum;
}

// Composite Simpson rule: exact for cubics, so ever finer for what is smooth.
template <typename Function>
double integrate(const Function& f, double from, double to, int steps) {
  const double h = (to - from) / steps;
  double sum = f(from) + f(to);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(from + i * h);
  return sum * h / 3.0;
}

TEST(BezierPiece, IsTheSumOfBernsteinPolynomials) {
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    const BezierPiece piece = random_piece(random);
    for (int i = 0; i <= 10; ++i) {
      const double t = piece.duration_s * i / 10.0;
      ASSERT_LT((piece.sample(t).position - bernstein_position(piece, t)).norm(), 1e-12);
    }
    EXPECT_EQ(piece.sample(0.0).position, Vec3(piece.control_points.col(0)));
    EXPECT_EQ(piece.sample(piece.duration_s).position, Vec3(piece.control_points.col(5)));
  }
}

TEST(BezierPiece, DerivativesAreTheFiniteDifferencesOfTheOneBefore) {
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    const BezierPiece piece = random_piece(random);
    const double h = 1e-5 * piece.duration_s;
    for (int i = 1; i < 10; ++i) {
      const double t = piece.duration_s * i / 10.0;
      const FlatState state = piece.sample(t);
      const FlatState before = piece.sample(t - h);
      const FlatState after = piece.sample(t + h);
      const auto near = [&](const Vec3& derivative, const Vec3& difference) {
        return (derivative - difference / (2.0 * h)).norm() <
               1e-6 * (1.0 + derivative.norm()) * std::pow(10.0 / piece.duration_s, 2);
      };
      ASSERT_TRUE(near(state.velocity, after.position - before.position));
      ASSERT_TRUE(near(state.acceleration, after.velocity - before.velocity));
      ASSERT_TRUE(near(state.jerk, after.acceleration - before.acceleration));
    }
  }
}

TEST(BezierPiece, DerivativePointsHaveTheirClosedForms) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const BezierPiece piece = random_piece(random);
    const double T = piece.duration_s;
    const auto c = [&](int j) { return Vec3(piece.control_points.col(j)); };
    const auto close = [](const Vec3& got, const Vec3& want) {
      return (got - want).norm() <= 1e-12 * (1.0 + want.norm());
    };
    for (int j = 0; j < 5; ++j) {
      ASSERT_TRUE(close(piece.velocity_points().col(j), 5.0 / T * (c(j + 1) - c(j))));
    }
    for (int j = 0; j < 4; ++j) {
      ASSERT_TRUE(close(piece.acceleration_points().col(j),
                        20.0 / (T * T) * (c(j + 2) - 2.0 * c(j + 1) + c(j))));
    }
    for (int j = 0; j < 3; ++j) {
      ASSERT_TRUE(close(piece.jerk_points().col(j),
                        60.0 / (T * T * T) * (c(j + 3) - 3.0 * c(j + 2) + 3.0 * c(j + 1) - c(j))));
    }
  }
}

TEST(BezierPiece, StaysBetweenTheExtremesOfItsControlPoints) {
  Random random(4);
  for (int n = 0; n < 200; ++n) {
    const BezierPiece piece = random_piece(random);
    const auto v = piece.velocity_points();
    const auto a = piece.acceleration_points();
    const double v_hull = v.colwise().norm().maxCoeff();
    const double a_hull = a.colwise().norm().maxCoeff();
    for (int i = 0; i <= 100; ++i) {
      const FlatState s = piece.sample(piece.duration_s * i / 100.0);
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_LE(s.position[axis], piece.control_points.row(axis).maxCoeff() + 1e-12);
        ASSERT_GE(s.position[axis], piece.control_points.row(axis).minCoeff() - 1e-12);
        ASSERT_LE(s.velocity[axis], v.row(axis).maxCoeff() + 1e-9);
        ASSERT_GE(s.acceleration[axis], a.row(axis).minCoeff() - 1e-9);
      }
      ASSERT_LE(s.velocity.norm(), v_hull * (1.0 + 1e-12));
      ASSERT_LE(s.acceleration.norm(), a_hull * (1.0 + 1e-12));
    }
  }
}

TEST(BezierPiece, BetweenHasTheEndsThatAreAskedFor) {
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    const FlatState start{random_vector(random, 9), random_vector(random, 3),
                          random_vector(random, 3), Vec3::Zero()};
    const FlatState end{random_vector(random, 9), random_vector(random, 3),
                        random_vector(random, 3), Vec3::Zero()};
    const double duration = random.uniform(0.1, 10.0);
    const BezierPiece piece = BezierPiece::between(start, end, duration);
    const auto differs = [&](const FlatState& a, const FlatState& b) {
      return (a.position - b.position).norm() + (a.velocity - b.velocity).norm() +
             (a.acceleration - b.acceleration).norm();
    };
    ASSERT_LT(differs(piece.sample(0.0), start), 1e-9 / (duration * duration));
    ASSERT_LT(differs(piece.sample(duration), end), 1e-9 / std::min(1.0, duration * duration));
  }
}

TEST(BezierPiece, RestToRestHasTheKnownPeaks) {
  // A rest-to-rest quintic over L in T: 1.875 L/T, 5.7735 L/T^2 and a jerk cost of 720 L^2/T^5.
  FlatState start;
  FlatState end;
  end.position = Vec3(3, 0, 4);
  Trajectory trajectory{{BezierPiece::between(start, end, 2.0)}};
  EXPECT_NEAR(trajectory.peaks(1000).speed_m_s, 1.875 * 5.0 / 2.0, 1e-4);
  EXPECT_NEAR(trajectory.peaks(1000).acceleration_m_s2, 5.7735 * 5.0 / 4.0, 1e-4);
  EXPECT_NEAR(trajectory.jerk_cost(), 720.0 * 25.0 / 32.0, 1e-9);
  EXPECT_NEAR(trajectory.length_m(), 5.0, 1e-9);
}

TEST(Trajectory, JerkCostIsTheIntegralOfTheSquaredJerk) {
  Random random(6);
  for (int n = 0; n < 50; ++n) {
    const Trajectory trajectory = random_trajectory(1 + random.below(4), random);
    double expected = 0.0;
    for (const auto& piece : trajectory.pieces) {
      expected += integrate([&](double t) { return piece.sample(t).jerk.squaredNorm(); }, 0.0,
                            piece.duration_s, 400);
    }
    ASSERT_NEAR(trajectory.jerk_cost(), expected, 1e-8 * expected);
  }
}

TEST(Trajectory, LengthIsTheIntegralOfTheSpeed) {
  Random random(7);
  for (int n = 0; n < 50; ++n) {
    // Curves as they are flown: no cusps, where eight points a piece would be few.
    Trajectory trajectory;
    FlatState state{random_vector(random, 3), Vec3(2, 0, 0), Vec3::Zero(), Vec3::Zero()};
    for (int k = 0; k < 4; ++k) {
      FlatState next = state;
      next.position += Vec3(2, random.uniform(-1, 1), random.uniform(-1, 1));
      next.velocity = Vec3(2, random.uniform(-1, 1), random.uniform(-1, 1));
      trajectory.pieces.push_back(BezierPiece::between(state, next, 1.0));
      state = next;
    }
    const double expected =
        integrate([&](double t) { return trajectory.sample(t).velocity.norm(); }, 0.0,
                  trajectory.duration_s(), 8000);
    ASSERT_NEAR(trajectory.length_m(), expected, 1e-4 * expected);
  }
}

TEST(Trajectory, SamplesThePieceThatIsFlownAtTheTime) {
  Random random(8);
  for (int n = 0; n < 50; ++n) {
    const Trajectory trajectory = random_trajectory(5, random);
    double begin = 0.0;
    for (const auto& piece : trajectory.pieces) {
      for (int i = 1; i < 10; ++i) {
        const double t = piece.duration_s * i / 10.0;
        ASSERT_LT((trajectory.sample(begin + t).position - piece.sample(t).position).norm(), 1e-10);
      }
      begin += piece.duration_s;
    }
    EXPECT_DOUBLE_EQ(trajectory.duration_s(), begin);
    const Vec3 last = trajectory.pieces.back().control_points.col(5);
    EXPECT_LT((trajectory.sample(trajectory.duration_s()).position - last).norm(), 1e-12);
    EXPECT_LT((trajectory.sample(trajectory.duration_s() + 1e-12).position - last).norm(), 1e-12);
    EXPECT_EQ(trajectory.sample(-1e-12).position,
              Vec3(trajectory.pieces.front().control_points.col(0)));
  }
}

TEST(Trajectory, SampleThrowsBeyondItsEndsAndForNaN) {
  Random random(9);
  const Trajectory trajectory = random_trajectory(2, random);
  EXPECT_THROW((void)trajectory.sample(-1e-3), std::out_of_range);
  EXPECT_THROW((void)trajectory.sample(trajectory.duration_s() + 1e-3), std::out_of_range);
  EXPECT_THROW((void)trajectory.sample(NAN), std::out_of_range);
  EXPECT_THROW((void)trajectory.sample(INFINITY), std::out_of_range);
  EXPECT_THROW((void)Trajectory{}.sample(0.0), std::logic_error);
}

TEST(BezierPiece, UntilATimeIsTheSameCurve) {
  Random random(11);
  for (int n = 0; n < 100; ++n) {
    BezierPiece piece = random_piece(random);
    piece.polytope = n;
    const double end_s = piece.duration_s * random.uniform(0.01, 1.0);
    const BezierPiece head = piece.until(end_s);
    EXPECT_EQ(head.duration_s, end_s);
    EXPECT_EQ(head.polytope, n);
    for (int i = 0; i <= 10; ++i) {
      const double t = end_s * i / 10.0;
      ASSERT_LT((head.sample(t).position - piece.sample(t).position).norm(), 1e-12);
      ASSERT_LT((head.sample(t).velocity - piece.sample(t).velocity).norm(), 1e-9 / end_s);
    }
  }
  const BezierPiece piece = random_piece(random);
  EXPECT_EQ(piece.until(piece.duration_s).control_points, piece.control_points);
}

TEST(Trajectory, UntilATimeKeepsThePiecesBeforeIt) {
  Random random(12);
  const Trajectory trajectory = random_trajectory(4, random);
  const double knot_s = trajectory.pieces[0].duration_s + trajectory.pieces[1].duration_s;
  EXPECT_EQ(trajectory.until(knot_s).pieces.size(), 2u) << "no piece of no length follows";
  EXPECT_EQ(trajectory.until(knot_s + 1e-12).pieces.size(), 2u);
  EXPECT_EQ(trajectory.until(trajectory.duration_s()).pieces.size(), 4u);
  const Trajectory head = trajectory.until(knot_s + 0.1);
  ASSERT_EQ(head.pieces.size(), 3u);
  EXPECT_NEAR(head.duration_s(), knot_s + 0.1, 1e-12);
  for (double t = 0.05; t < head.duration_s(); t += 0.05) {
    ASSERT_LT((head.sample(t).position - trajectory.sample(t).position).norm(), 1e-12) << t;
  }
  for (const double outside : {0.0, -1.0, double(NAN), trajectory.duration_s() + 0.1}) {
    EXPECT_THROW((void)trajectory.until(outside), std::out_of_range) << outside;
  }
}

TEST(FlatState, DifferenceIsTheLargestOfItsPartsAndNaNStays) {
  Random random(13);
  const auto apart = [](Vec3 position, Vec3 velocity, Vec3 acceleration) {
    return largest_difference({position, velocity, acceleration}, {});
  };
  EXPECT_EQ(apart(Vec3(3, 4, 0), Vec3(1, 0, 0), Vec3(0, 2, 0)), 5.0);
  EXPECT_EQ(apart(Vec3(0, 1, 0), Vec3(0, 0, -6), Vec3(0, 2, 0)), 6.0);
  EXPECT_EQ(apart(Vec3(0, 1, 0), Vec3(0, 0, -6), Vec3(0, -8, 0)), 8.0);
  for (int part = 0; part < 3; ++part) {
    Vec3 v[3] = {random_vector(random, 1.0), random_vector(random, 1.0), Vec3(9, 9, 9)};
    v[part].y() = NAN;
    EXPECT_TRUE(std::isnan(apart(v[0], v[1], v[2]))) << part;
    EXPECT_FALSE((FlatState{v[0], v[1], v[2]}.is_finite())) << part;
  }
  EXPECT_TRUE(FlatState{}.is_finite());
}

TEST(Trajectory, PeaksGrowWithTheSamplesUpToTheHull) {
  Random random(10);
  for (int n = 0; n < 50; ++n) {
    const Trajectory trajectory = random_trajectory(3, random);
    const auto coarse = trajectory.peaks(8);
    const auto fine = trajectory.peaks(64);  // a superset of the coarse samples
    double v_hull = 0.0;
    for (const auto& piece : trajectory.pieces) {
      v_hull = std::max(v_hull, piece.velocity_points().colwise().norm().maxCoeff());
    }
    ASSERT_LE(coarse.speed_m_s, fine.speed_m_s);
    ASSERT_LE(coarse.acceleration_m_s2, fine.acceleration_m_s2);
    ASSERT_LE(fine.speed_m_s, v_hull * (1.0 + 1e-12));
  }
  EXPECT_THROW((void)Trajectory{}.peaks(0), std::invalid_argument);
}

TEST(Trajectory, PeaksOfNaNAreNotAtRest) {
  Random random(11);
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 6; ++j) {
      Trajectory trajectory = random_trajectory(3, random);
      trajectory.pieces[std::size_t(k)].control_points(j % 3, j) = NAN;
      EXPECT_TRUE(std::isnan(trajectory.peaks().speed_m_s));
      EXPECT_TRUE(std::isnan(trajectory.peaks().acceleration_m_s2));
    }
  }
}

TEST(Trajectory, CheckNamesTheFault) {
  Random random(12);
  EXPECT_TRUE(random_trajectory(3, random).check().ok());
  EXPECT_EQ(Trajectory{}.check().code(), ErrorCode::invalid_input);
  for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)}) {
    Trajectory trajectory = random_trajectory(3, random);
    trajectory.pieces[2].duration_s = bad;
    const auto status = trajectory.check();
    EXPECT_EQ(status.code(), ErrorCode::invalid_input);
    EXPECT_NE(status.error().message.find("piece 2"), std::string::npos);
  }
  for (const double bad : {double(NAN), double(INFINITY)}) {
    Trajectory trajectory = random_trajectory(3, random);
    trajectory.pieces[1].control_points(2, 5) = bad;
    EXPECT_EQ(trajectory.check().code(), ErrorCode::invalid_input);
  }
}

}  // namespace
}  // namespace goshawk
