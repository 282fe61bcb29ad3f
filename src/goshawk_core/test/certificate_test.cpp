#include "goshawk/core/certificate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

struct Plan {
  Trajectory trajectory;
  std::vector<Polytope> polytopes;
  Limits limits{.v_max_m_s = 20.0, .a_max_m_s2 = 100.0, .norm = LimitNorm::euclidean};
  FlatState start;
  FlatState goal;

  Certificate certificate() const { return measure(trajectory, polytopes, limits, start, goal); }
};

void shrink(Polytope& polytope, double by_m) {
  for (HalfSpace& face : polytope.half_spaces) face.offset_m -= by_m;
}

// Smooth through three pieces, inside wide boxes and wide limits: every family holds.
Plan good_plan(Random& random) {
  Plan plan;
  FlatState state;
  plan.start = state;
  for (int k = 0; k < 3; ++k) {
    FlatState next;
    next.position = state.position + Vec3(1, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    if (k < 2) {
      next.velocity = Vec3(1, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
      next.acceleration = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 0);
    }
    plan.trajectory.pieces.push_back(BezierPiece::between(state, next, random.uniform(0.8, 1.5)));
    plan.trajectory.pieces.back().polytope = k;
    plan.polytopes.push_back(
        Polytope::box(state.position - Vec3::Constant(5), next.position + Vec3::Constant(5)));
    state = next;
  }
  plan.goal = state;
  return plan;
}

TEST(Certificate, HoldsForASmoothTrajectoryInsideItsLimits) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const Plan plan = good_plan(random);
    const Certificate c = plan.certificate();
    ASSERT_TRUE(c.holds()) << c.worst();
    ASSERT_LT(c.position_m, 0.0);
    ASSERT_LT(c.velocity_m_s, 0.0);
    ASSERT_LT(c.acceleration_m_s2, 0.0);
    ASSERT_LT(c.continuity_position_m + c.continuity_velocity_m_s + c.continuity_acceleration_m_s2,
              1e-9);
  }
}

TEST(Certificate, BoundsWhatDenseSamplingFinds) {
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    Plan plan = good_plan(random);
    plan.limits.norm = n % 2 == 0 ? LimitNorm::euclidean : LimitNorm::per_axis;
    plan.limits.v_max_m_s = random.uniform(0.5, 5.0);
    plan.limits.a_max_m_s2 = random.uniform(0.5, 20.0);
    for (auto& polytope : plan.polytopes) shrink(polytope, random.uniform(0.0, 5.5));
    const Certificate c = plan.certificate();
    const auto size = [&](const Vec3& v) {
      return n % 2 == 0 ? v.norm() : v.cwiseAbs().maxCoeff();
    };
    double position = -HUGE_VAL;
    double speed = 0.0;
    double acceleration = 0.0;
    for (const auto& piece : plan.trajectory.pieces) {
      for (int i = 0; i <= 200; ++i) {
        const FlatState s = piece.sample(piece.duration_s * i / 200.0);
        position =
            std::max(position, plan.polytopes[std::size_t(piece.polytope)].violation(s.position));
        speed = std::max(speed, size(s.velocity));
        acceleration = std::max(acceleration, size(s.acceleration));
      }
    }
    ASSERT_GE(c.position_m, position - 1e-9);
    ASSERT_GE(c.velocity_m_s, speed - plan.limits.v_max_m_s - 1e-9);
    ASSERT_GE(c.acceleration_m_s2, acceleration - plan.limits.a_max_m_s2 - 1e-9);
  }
}

TEST(Certificate, MeasuresEachViolation) {
  Random random(3);
  const Plan good = good_plan(random);
  const auto broken = [&](const std::function<void(Plan&)>& harm) {
    Plan plan = good;
    harm(plan);
    return plan.certificate();
  };
  const auto names = [](const Certificate& c, const std::string& family) {
    EXPECT_FALSE(c.holds());
    EXPECT_EQ(c.worst().rfind(family + " is violated", 0), 0U) << c.worst();
  };
  // The start is 5 m inside each face of its box: 5.5 m off puts it 0.5 m outside.
  const auto wall = broken([](Plan& p) { shrink(p.polytopes[0], 5.5); });
  EXPECT_NEAR(wall.position_m, 0.5, 0.5);
  EXPECT_GE(wall.position_m, 0.5 - 1e-12);
  names(wall, "position");
  const auto start = broken([](Plan& p) { p.start.velocity.x() += 0.25; });
  EXPECT_NEAR(start.start_m, 0.25, 1e-9);
  names(start, "start");
  const auto goal = broken([](Plan& p) { p.goal.acceleration.z() -= 0.125; });
  EXPECT_NEAR(goal.goal_m, 0.125, 1e-9);
  names(goal, "goal");
  const auto jump =
      broken([](Plan& p) { p.trajectory.pieces[1].control_points.colwise() += Vec3(0.01, 0, 0); });
  EXPECT_NEAR(jump.continuity_position_m, 0.01, 1e-12);
  names(jump, "position continuity");
  const auto kink = broken([](Plan& p) { p.trajectory.pieces[1].duration_s *= 1.1; });
  EXPECT_GT(kink.continuity_velocity_m_s, 0.05);
  EXPECT_GT(kink.continuity_acceleration_m_s2, 0.0);
  EXPECT_FALSE(kink.holds());
  const auto fast = broken([](Plan& p) { p.limits.v_max_m_s = 0.1; });
  EXPECT_GT(fast.velocity_m_s, 0.9);  // it passes its knots with more than 1 m/s
  names(fast, "velocity");
  const auto hard = broken([](Plan& p) { p.limits.a_max_m_s2 = 0.1; });
  EXPECT_GT(hard.acceleration_m_s2, 0.0);
  names(hard, "acceleration");
}

TEST(Certificate, EuclideanLimitsAreTighterThanPerAxis) {
  FlatState start;
  FlatState end;
  end.position = Vec3(1, 1, 1);
  Plan plan;
  plan.trajectory.pieces = {BezierPiece::between(start, end, 5.0)};
  plan.polytopes = {Polytope::box(Vec3::Constant(-1), Vec3::Constant(2))};
  plan.goal = end;
  // Along the diagonal of a cube: the length is sqrt(3) times a component. The hull's fastest
  // velocity point of a rest-to-rest quintic is 5 L/T.
  plan.limits = {.v_max_m_s = 1.2, .a_max_m_s2 = 10.0, .norm = LimitNorm::per_axis};
  EXPECT_NEAR(plan.certificate().velocity_m_s, 1.0 - 1.2, 1e-12);
  EXPECT_TRUE(plan.certificate().holds());
  plan.limits.norm = LimitNorm::euclidean;
  EXPECT_NEAR(plan.certificate().velocity_m_s, std::sqrt(3.0) - 1.2, 1e-12);
  EXPECT_FALSE(plan.certificate().holds());
}

TEST(Certificate, ToleratesWhatTheToleranceSays) {
  Certificate c;
  EXPECT_TRUE(c.holds());
  c.continuity_velocity_m_s = 1e-5;
  EXPECT_FALSE(c.holds());
  EXPECT_TRUE(c.holds(1e-4));
  EXPECT_FALSE(c.holds(NAN));
  EXPECT_EQ(c.worst(), "velocity continuity is violated by 1e-05");
}

// A certificate that ignores one NaN lets a vehicle fly anywhere: every number that goes in is
// replaced by NaN, one at a time.
TEST(Certificate, DoesNotHoldForNaNInAnyNumberOfAnyPiece) {
  Random random(4);
  const Plan good = good_plan(random);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), double(INFINITY)}) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (int i = 0; i < 18; ++i) {
        Plan plan = good;
        plan.trajectory.pieces[k].control_points(i % 3, i / 3) = bad;
        ASSERT_FALSE(plan.certificate().holds()) << "control point of piece " << k << ", " << i;
      }
      Plan plan = good;
      plan.trajectory.pieces[k].duration_s = bad;
      ASSERT_FALSE(plan.certificate().holds()) << "duration of piece " << k;
      for (std::size_t face = 0; face < 6; ++face) {
        plan = good;
        plan.polytopes[k].half_spaces[face].offset_m = bad;
        ASSERT_FALSE(plan.certificate().holds()) << "offset " << face;
        for (int axis = 0; axis < 3; ++axis) {
          plan = good;
          plan.polytopes[k].half_spaces[face].normal[axis] = bad;
          ASSERT_FALSE(plan.certificate().holds()) << "normal " << face;
        }
      }
    }
  }
}

TEST(Certificate, DoesNotHoldForNaNInTheEndsOrTheLimits) {
  Random random(5);
  const Plan good = good_plan(random);
  const std::vector<std::function<double&(Plan&)>> numbers{
      [](Plan& p) -> double& { return p.start.position.x(); },
      [](Plan& p) -> double& { return p.start.velocity.y(); },
      [](Plan& p) -> double& { return p.start.acceleration.z(); },
      [](Plan& p) -> double& { return p.goal.position.z(); },
      [](Plan& p) -> double& { return p.goal.velocity.x(); },
      [](Plan& p) -> double& { return p.goal.acceleration.y(); },
      [](Plan& p) -> double& { return p.limits.v_max_m_s; },
      [](Plan& p) -> double& { return p.limits.a_max_m_s2; }};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)}) {
      Plan plan = good;
      numbers[i](plan) = bad;
      EXPECT_FALSE(plan.certificate().holds()) << "number " << i << " is " << bad;
    }
  }
}

TEST(Certificate, DoesNotHoldForWhatIsNoTrajectoryOrNoPolytope) {
  Random random(6);
  const Plan good = good_plan(random);
  for (const double duration : {0.0, -1.0}) {
    for (auto& piece : good.trajectory.pieces) {
      Plan plan = good;
      plan.trajectory.pieces[std::size_t(piece.polytope)].duration_s = duration;
      EXPECT_FALSE(plan.certificate().holds());
      // At rest: nothing else would notice.
      plan.trajectory.pieces.assign(1, BezierPiece());
      plan.trajectory.pieces[0].duration_s = duration;
      plan.start = plan.goal = {};
      EXPECT_FALSE(plan.certificate().holds());
    }
  }
  Plan plan = good;
  plan.polytopes[1] = Polytope();
  EXPECT_FALSE(plan.certificate().holds());
  EXPECT_TRUE(std::isnan(plan.certificate().position_m));
  EXPECT_EQ(plan.certificate().worst(), "position is violated by nan");
}

TEST(Certificate, ThrowsForAPolytopeThatIsNotThereAndForNoPieces) {
  Random random(7);
  for (const int polytope : {-1, 3, std::numeric_limits<int>::max()}) {
    Plan plan = good_plan(random);
    plan.trajectory.pieces[1].polytope = polytope;
    EXPECT_THROW((void)plan.certificate(), std::out_of_range);
  }
  Plan plan = good_plan(random);
  plan.trajectory.pieces.clear();
  EXPECT_THROW((void)plan.certificate(), std::logic_error);
}

// A polytope that holds for a time: a piece may neither begin before nor end after it.
TEST(Certificate, DoesNotHoldForAPieceThatOutlastsItsPolytope) {
  Random random(8);
  Plan plan = good_plan(random);
  EXPECT_EQ(plan.certificate().validity_s, 0.0) << "no polytope has an interval";
  plan.polytopes.push_back(plan.polytopes[0]);
  plan.polytopes.back().valid_until_s = 0.001;
  EXPECT_EQ(plan.certificate().validity_s, 0.0) << "no piece is in the one that has";
  const double begin_s = plan.trajectory.pieces[0].duration_s;
  const double end_s = begin_s + plan.trajectory.pieces[1].duration_s;
  const auto with = [&](double from_s, double until_s) {
    plan.polytopes[1].valid_from_s = from_s;
    plan.polytopes[1].valid_until_s = until_s;
    return plan.certificate();
  };
  EXPECT_TRUE(with(begin_s, end_s).holds());
  EXPECT_NEAR(with(begin_s - 0.5, end_s + 0.25).validity_s, -0.25, 1e-12);
  EXPECT_NEAR(with(begin_s - 0.5, end_s - 0.125).validity_s, 0.125, 1e-12);
  EXPECT_NEAR(with(begin_s + 0.0625, end_s + 1.0).validity_s, 0.0625, 1e-12);
  EXPECT_EQ(with(begin_s - 0.5, end_s - 0.125).worst(), "validity is violated by 0.125");
  EXPECT_FALSE(with(begin_s, end_s - 0.125).holds());
  EXPECT_FALSE(with(0.0, NAN).holds());
}

/// The largest use of limits and the largest jerk that samples of a trajectory show.
struct Sampled {
  double speed = 0.0, acceleration = 0.0;  // of the limits
  double jerk_m_s3 = 0.0;
};

Sampled sample(const Plan& plan, double from_s = 0.0) {
  Sampled most;
  const Limits& l = plan.limits;
  const auto use = [](const Vec3& v, double horizontal, double vertical) {
    return std::max(std::hypot(v.x(), v.y()) / horizontal, std::abs(v.z()) / vertical);
  };
  const double end_s = plan.trajectory.duration_s();
  for (int k = 0; k <= 600; ++k) {
    const FlatState s = plan.trajectory.sample(from_s + (end_s - from_s) * k / 600.0);
    most.speed = std::max(most.speed, use(s.velocity, l.v_max_m_s, l.v_max_vertical_m_s));
    most.acceleration =
        std::max(most.acceleration, use(s.acceleration, l.a_max_m_s2, l.a_max_vertical_m_s2));
    most.jerk_m_s3 = std::max(most.jerk_m_s3, s.jerk.norm());
  }
  return most;
}

TEST(Certificate, BoundsSamplesOfTheJerkAndOfHorizontalAndVerticalMotionApart) {
  Random random(9);
  double bounds = 0.0, samples = 0.0;
  for (int n = 0; n < 200; ++n) {
    Plan plan = good_plan(random);
    plan.limits = {.v_max_m_s = random.uniform(0.5, 5.0),
                   .a_max_m_s2 = random.uniform(0.5, 20.0),
                   .norm = LimitNorm::horizontal_vertical,
                   .j_max_m_s3 = random.uniform(1.0, 50.0),
                   .v_max_vertical_m_s = random.uniform(0.1, 1.0),
                   .a_max_vertical_m_s2 = random.uniform(0.5, 5.0)};
    const Certificate c = plan.certificate();
    const Sampled most = sample(plan);
    ASSERT_GE(c.velocity_m_s, (most.speed - 1.0) * plan.limits.v_max_m_s - 1e-9);
    ASSERT_GE(c.acceleration_m_s2, (most.acceleration - 1.0) * plan.limits.a_max_m_s2 - 1e-9);
    ASSERT_GE(c.jerk_m_s3, most.jerk_m_s3 - plan.limits.j_max_m_s3 - 1e-9);
    bounds += c.jerk_m_s3 + plan.limits.j_max_m_s3;
    samples += most.jerk_m_s3;
  }
  EXPECT_LT(bounds, 2.5 * samples) << "a bound, but no loose one";
}

/// Braking from a start that is too fast, in eight pieces; the limits are 2 m/s and 4 m/s^2.
Plan braking(Random& random) {
  Plan plan;
  plan.limits = {.v_max_m_s = 2.0,
                 .a_max_m_s2 = 4.0,
                 .norm = LimitNorm::horizontal_vertical,
                 .v_max_vertical_m_s = 2.0,
                 .a_max_vertical_m_s2 = 4.0};
  plan.start.velocity = Vec3(random.uniform(2.05, 3.0), 0.0, random.uniform(-0.5, 0.5));
  plan.goal.velocity = Vec3(random.uniform(0.5, 2.2), 0.0, 0.0);
  const double lasts_s = random.uniform(0.5, 2.0);
  plan.goal.position = 0.5 * lasts_s * (plan.start.velocity + plan.goal.velocity);
  const Trajectory whole{{BezierPiece::between(plan.start, plan.goal, lasts_s)}};
  for (int k = 0; k < 8; ++k) {
    plan.trajectory.pieces.push_back(BezierPiece::between(
        whole.sample(lasts_s * k / 8.0), whole.sample(lasts_s * (k + 1) / 8.0), lasts_s / 8.0));
  }
  plan.polytopes = {Polytope::box(Vec3::Constant(-9.0), Vec3::Constant(9.0))};
  return plan;
}

TEST(Certificate, OfAStartThatIsTooFastNamesTheMomentFromWhichTheLimitsHold) {
  Random random(10);
  int good = 0, bad = 0, back = 0;
  for (int n = 0; n < 400; ++n) {
    const Plan plan = braking(random);
    const Certificate c = plan.certificate();
    const auto allowance = StartAllowance::of(plan.start, plan.limits);
    const Sampled all = sample(plan);
    if (!c.holds()) {
      ++bad;
      continue;
    }
    ++good;
    ASSERT_GE(c.start_excess_m_s, (all.speed - 1.0) * plan.limits.v_max_m_s - 1e-9);
    ASSERT_GE(c.start_excess_m_s2, (all.acceleration - 1.0) * plan.limits.a_max_m_s2 - 1e-9);
    ASSERT_LE(all.speed, allowance.speed + 1e-6);
    ASSERT_LE(all.acceleration, allowance.acceleration + 1e-6);
    ASSERT_GT(c.start_excess_s, 0.0);
    if (c.start_excess_s < plan.trajectory.duration_s() - 1e-9) {  // else nothing comes after it
      ++back;
      const Sampled later = sample(plan, c.start_excess_s);
      ASSERT_LE(later.speed, 1.0 + 1e-6);
      ASSERT_LE(later.acceleration, 1.0 + 1e-6);
    }
    // Not long before, something is above its limit.
    const double piece_s = plan.trajectory.pieces[0].duration_s;
    const Sampled before = sample(plan, std::max(0.0, c.start_excess_s - 1.5 * piece_s));
    ASSERT_GT(std::max(before.speed, before.acceleration), 1.0 - 0.05);
  }
  EXPECT_GT(good, 50);
  EXPECT_GT(bad, 50);
  EXPECT_GT(back, 30);
}

}  // namespace
}  // namespace goshawk
