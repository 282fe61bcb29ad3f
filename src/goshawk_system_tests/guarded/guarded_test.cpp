// Planners that nobody should let fly, behind the guard: in a known world and in one that unfolds.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>

#include "bad_planners.hpp"
#include "goshawk/core/free_curve.hpp"

namespace goshawk::guarded {
namespace {

const Vec3 kHome(1.1, 5.1, 1.5), kGoal(18.9, 5.1, 1.5);
constexpr double kFlight_s = 15.0;
constexpr double kMargin_m = 0.05;  // for tracking

int count_of_worlds() {
  const char* text = std::getenv("GOSHAWK_GUARDED");
  return text != nullptr ? std::atoi(text) : kFaults;
}

worlds::World made(int seed) {
  worlds::WorldSpec spec;
  spec.kind = seed % 2 == 0 ? "forest" : "boxes";
  spec.size_m = Vec3(20.0, 10.0, 3.0);
  spec.density = 0.1 + 0.05 * (seed % 3);
  spec.seed = std::uint64_t(seed);
  spec.keep_free = {kHome, kGoal};
  return worlds::make_world(spec).value();
}

/// Of the limits, by samples: not by the certificate, which says so already.
double largest_use(const CommittedTrajectory& committed, const Limits& limits) {
  const Trajectory& flown = committed.flown();
  double use = 0.0;
  for (const BezierPiece& piece : flown.pieces) {
    for (int i = 0; i <= 16; ++i) {
      const FlatState s = piece.sample(piece.duration_s * i / 16);
      use =
          std::max({use, limits.speed_usage(s.velocity), limits.acceleration_usage(s.acceleration),
                    s.jerk.norm() / limits.j_max_m_s3});
    }
  }
  return use;
}

struct Tally {
  int flights = 0;
  double travelled_m = 0.0;
  std::map<guard::Verdict, int> verdicts = {};
  int trimmed = 0;
};

void print(std::string_view name, const Tally& tally) {
  const auto count = [&](guard::Verdict v) {
    const auto at = tally.verdicts.find(v);
    return at == tally.verdicts.end() ? 0 : at->second;
  };
  std::printf(
      "%-10s %3d flights, %6.1f m each; passed %d, slowed %d, replaced %d, refused %d; "
      "trimmed %d\n",
      std::string(name).c_str(), tally.flights, tally.travelled_m / tally.flights,
      count(guard::Verdict::passed), count(guard::Verdict::slowed), count(guard::Verdict::replaced),
      count(guard::Verdict::refused), tally.trimmed);
}

TEST(GuardedPlanners, TouchNothingAndKeepEveryLimitWhateverTheyPlan) {
  const guard::Config config;
  std::map<Fault, Tally> tallies;
  for (int seed = 1; seed <= count_of_worlds(); ++seed) {
    const Fault fault = Fault(seed % kFaults);
    SCOPED_TRACE(testing::Message() << "world " << seed << ", " << to_string(fault));
    const bool unfolds = (seed / kFaults) % 2 == 0;
    GuardLab lab(made(seed), unfolds ? 5.0 : std::numeric_limits<double>::infinity(), kHome);
    BadPlanner planner(fault, kGoal, std::uint64_t(seed));
    lab.run(kFlight_s, [&] { planner.tick(lab); });
    lab.run(6.0);  // the planner has died
    EXPECT_LT(lab.velocity().norm(), 0.1);

    const auto verdict = lab.judge();
    EXPECT_FALSE(verdict.touched) << verdict.sentence;
    EXPECT_LT(lab.max_error_m, kMargin_m);
    EXPECT_LT(lab.max_speed_m_s, 1.1 * config.v_max_m_s);
    for (const auto& committed : lab.commits) {
      EXPECT_LE(largest_use(committed, config.limits()), 1.0 + 1e-6) << committed.id();
    }
    for (const Error& loss : lab.losses) EXPECT_EQ(loss.code, ErrorCode::trajectory_blocked);
    for (const Error& refusal : lab.refusals) ADD_FAILURE() << refusal.message;
    Tally& tally = tallies[fault];
    ++tally.flights;
    tally.travelled_m += lab.travelled_m;
    for (const auto& decision : lab.decisions) {
      ++tally.verdicts[decision.verdict];
      tally.trimmed += decision.trimmed ? 1 : 0;
    }
  }
  for (const auto& [fault, tally] : tallies) {
    print(to_string(fault), tally);
    EXPECT_GT(tally.travelled_m, 0.5 * tally.flights) << "it is safe to fly, not to stand still";
  }
}

}  // namespace
}  // namespace goshawk::guarded
