// The second opinion among things that move, against FCL at dense times.
#include "goshawk/flight_check/mover_check.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/core/random.hpp"
#include "goshawk/flight_check/watch.hpp"

namespace goshawk::flight_check {
namespace {

using movers::Mover;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kTolerance_m = 1e-3;

Mover crossing(std::uint64_t id, double x_m, double speed_m_s) {
  movers::WalkParameters p{.points_map = {Vec3(x_m, -4, 1), Vec3(x_m, 4, 1)},
                           .speed_m_s = speed_m_s,
                           .turn_rate_rad_s = 0.0,
                           .repeat = movers::Repeat::once};
  return {.id = id,
          .kind = "person",
          .half_m = Vec3(0.25, 0.25, 0.9),
          .motion = movers::Walk::create(p).value()};
}

std::vector<Sample> straight(const Vec3& from, const Vec3& to, double from_s, double to_s, int n) {
  std::vector<Sample> track;
  for (int i = 0; i <= n; ++i) {
    const double part = double(i) / n;
    track.push_back({from_s + part * (to_s - from_s), from + part * (to - from)});
  }
  return track;
}

MoverVerdict judge(const std::vector<Mover>& movers, const std::vector<Sample>& track) {
  return MoverCheck::create(movers, 0.0)->judge(track).value();
}

Vec3 random_vector(Random& random, double most) {
  const double x = random.uniform(-most, most), y = random.uniform(-most, most);
  return {x, y, random.uniform(-most, most)};
}

Mover random_mover(Random& random, bool slides) {
  Mover m{.id = 1, .half_m = Vec3::Constant(0.5) + random_vector(random, 0.4)};
  if (slides) {
    m.motion = movers::Slide{random_vector(random, 2.0), random_vector(random, 2.0), 1.5};
  } else {
    m.motion = movers::Trefoil{random_vector(random, 2.0), Vec3(2, 3, 3), 1.0, 0.8};
  }
  return m;
}

/// FCL's smallest clearance from the mover as it stands at many moments.
double dense_clearance_m(const Mover& mover, const Sample& a, const Sample& b) {
  double smallest = 1e9;
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps; ++i) {
    const double part = double(i) / kSteps, t_s = a.t_s + part * (b.t_s - a.t_s);
    Mover stands{.id = 1, .half_m = mover.half_m};
    stands.motion = movers::Still{mover.at(t_s).position_map, 0.0};
    const Sample there{t_s, a.position_map + part * (b.position_map - a.position_map)};
    smallest = std::min(smallest, judge({stands}, {there}).clearance_m);
  }
  return smallest;
}

TEST(MoverCheck, TheSmallestClearanceIsThatOfFclAtDenseTimes) {
  Random random(5);
  int touched = 0;
  for (int i = 0; i < 120; ++i) {
    const Mover mover = random_mover(random, i % 2 == 0);
    const Sample a{0.0, random_vector(random, 3.0)};
    const Sample b{random.uniform(0.1, 1.0), random_vector(random, 3.0)};
    const MoverVerdict v = judge({mover}, {a, b});
    const double dense_m = dense_clearance_m(mover, a, b);
    touched += v.touched.empty() ? 0 : 1;
    // Dense times may pass over a short contact; the check may not.
    EXPECT_LE(v.clearance_m, dense_m + kTolerance_m) << i;
    const double step_m =
        ((b.position_map - a.position_map).norm() + mover.top_speed_m_s() * b.t_s) / 400.0;
    EXPECT_GE(v.clearance_m, dense_m - step_m - kTolerance_m) << i;
  }
  EXPECT_GT(touched, 10);
  EXPECT_LT(touched, 110);
}

TEST(MoverCheck, WhatPassesBetweenTwoSamplesIsFound) {
  const std::vector<Sample> hover{{0.0, Vec3(0, 0, 1)}, {0.4, Vec3(0, 0, 1)}};
  const MoverVerdict v = judge({crossing(3, 0.0, 40.0)}, hover);
  EXPECT_THAT(v.touched, ElementsAre(3));
  // It has 4 m to go, less its half and the vehicle's radius.
  EXPECT_NEAR(v.clearance_t_s, (4.0 - 0.25 - 0.15) / 40.0, 1e-4);
  EXPECT_THAT(v.sentence(), HasSubstr("touched mover 3 (person) at 0.090 s"));
}

TEST(MoverCheck, EachMoverCountsOnceAndTheFirstIsNamed) {
  const std::vector<Mover> movers{crossing(1, 6.0, 1.0), crossing(2, 2.0, 2.0),
                                  crossing(3, 4.0, 1.0), crossing(4, 4.0, 0.1)};
  const auto track = straight(Vec3(0, 0, 1), Vec3(8, 0, 1), 0.0, 8.0, 80);
  const MoverVerdict v = judge(movers, track);
  EXPECT_THAT(v.touched, ElementsAre(2, 3));
  EXPECT_EQ(v.mover, "mover 2 (person)");
  EXPECT_THAT(v.sentence(), HasSubstr("touched 2 movers, first mover 2 (person), at"));
}

TEST(MoverCheck, TimesCountFromTheMoversStart) {
  const std::vector<Sample> hover{{100.0, Vec3(0, 0, 1)}, {101.0, Vec3(0, 0, 1)}};
  const auto early = MoverCheck::create({crossing(1, 0.0, 4.0)}, 99.5)->judge(hover);
  const auto late = MoverCheck::create({crossing(1, 0.0, 4.0)}, 101.0)->judge(hover);
  EXPECT_FALSE(early->touched.empty());
  EXPECT_TRUE(late->touched.empty());
  EXPECT_THAT(late->sentence(), HasSubstr("touched nothing that moves: smallest clearance"));
}

TEST(MoverCheck, BadInputIsRefused) {
  EXPECT_EQ(MoverCheck::create({}, std::nan("")).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(MoverCheck::create({}, 0.0, Body{.radius_m = -1.0}).code(),
            ErrorCode::invalid_parameter);
  const auto check = MoverCheck::create({crossing(1, 0.0, 1.0)}, 0.0);
  EXPECT_EQ(check->judge({}).code(), ErrorCode::invalid_input);
  const std::vector<Sample> bad{{std::nan(""), Vec3::Zero()}};
  EXPECT_EQ(check->judge(bad).code(), ErrorCode::invalid_input);
  EXPECT_THAT(MoverCheck::create({}, 0.0)->judge(std::vector<Sample>{{}})->sentence(),
              HasSubstr("nothing does"));
}

TEST(Watch, AContactWithAMoverIsToldOnceAndApartFromTheWorld) {
  Watch watch;
  watch.set_movers(MoverCheck::create({crossing(5, 0.0, 2.0)}, 0.0).value());
  std::vector<Finding> findings;
  for (int i = 0; i <= 60; ++i) {  // it stands in the way from 1.8 to 2.2 s
    watch.fly({{0.05 * i, Vec3(0, 0, 1)}, 0.0});
    watch.tick(0.05 * i);
    for (auto& f : watch.take_findings()) findings.push_back(std::move(f));
  }
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].kind, Finding::Kind::mover);
  EXPECT_THAT(findings[0].movers->touched, ElementsAre(5));
  EXPECT_THAT(findings[0].outcome.error().message, HasSubstr("mover 5 (person)"));
}

TEST(Watch, WithoutAMapTheMoversAreStillJudged) {
  Watch watch;
  watch.set_movers(MoverCheck::create({crossing(5, 0.0, 2.0)}, 0.0).value());
  watch.commit({.request_id = 7,
                .start_s = 0.0,
                .nominal = {{0.0, Vec3(3, 0, 1)}, {1.5, Vec3(3, 0, 1)}},
                .stop = {}});
  std::vector<Finding> flown;
  const auto collect = [&](Finding::Kind kind) {
    for (auto& f : watch.take_findings()) {
      if (f.kind == kind) flown.push_back(std::move(f));
    }
  };
  for (int i = 0; i <= 60; ++i) {
    watch.fly({{0.05 * i, Vec3(3, 0, 1)}, 0.0});
    watch.tick(0.05 * i);
    collect(Finding::Kind::flown);
  }
  ASSERT_EQ(flown.size(), 1u);
  EXPECT_EQ(flown[0].request_id, 7u);
  EXPECT_EQ(flown[0].outcome.code(), ErrorCode::no_map);
  EXPECT_THAT(flown[0].outcome.error().message, HasSubstr("touched nothing that moves"));
  ASSERT_TRUE(flown[0].movers);
  EXPECT_NEAR(flown[0].movers->clearance_m, 3.0 - 0.25 - 0.15, 2e-3);
  // A track that cannot be judged is reported, not passed over.
  flown.clear();
  watch.fly({{3.05, Vec3(3, 0, 1), Quaternion(2, 0, 0, 0)}, 0.0});
  watch.tick(3.05);
  collect(Finding::Kind::event);
  ASSERT_EQ(flown.size(), 1u);
  EXPECT_EQ(flown[0].outcome.code(), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::flight_check
