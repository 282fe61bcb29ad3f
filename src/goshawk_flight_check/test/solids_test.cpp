// Flights among solids, judged against distances by closed formulas and by dense sampling.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "goshawk/core/random.hpp"
#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {
namespace {

constexpr Body kCylinderBody{.radius_m = 0.15, .height_m = 0.1};

Solid pillar(double x, double y, double radius_m, double height_m) {
  return {.center_map = Vec3(x, y, height_m / 2.0),
          .size_m = Vec3(2.0 * radius_m, 2.0 * radius_m, height_m)};
}
Solid box(const Vec3& lower, const Vec3& upper) {
  return {.is_box = true, .center_map = 0.5 * (lower + upper), .size_m = upper - lower};
}

std::vector<Sample> straight(const Vec3& from, const Vec3& to) {
  std::vector<Sample> track;
  for (int i = 0; i <= 100; ++i) track.push_back({0.02 * i, from + i / 100.0 * (to - from)});
  return track;
}

/// [m] from a point to a pillar, by its definition
double distance_m(const Solid& pillar, const Vec3& p) {
  const Vec3 off = (p - pillar.center_map).cwiseAbs();
  const double aside = std::max(0.0, off.head<2>().norm() - pillar.size_m.x() / 2.0);
  const double above = std::max(0.0, off.z() - pillar.size_m.z() / 2.0);
  return std::hypot(aside, above);
}

TEST(Solids, AFlightPastAPillarKeepsItsDistance) {
  const auto check = FlightCheck::from_solids(std::vector{pillar(2.0, 1.0, 0.5, 4.0)}).value();
  const auto verdict = check.judge(straight(Vec3(0, 0, 2), Vec3(4, 0, 2))).value();
  EXPECT_FALSE(verdict.touched);
  EXPECT_NEAR(verdict.clearance_m, 1.0 - 0.5 - 0.15, 1.1e-3);
  EXPECT_NEAR(verdict.clearance_t_s, 1.0, 0.1);
  EXPECT_NEAR(verdict.clearance_place_map.y(), 0.5, 0.02);
}

TEST(Solids, AFlightThroughAnyOfThemTouches) {
  std::vector<Solid> solids;
  for (int i = 0; i < 200; ++i) solids.push_back(pillar(3.0 * i, 50.0, 0.5, 4.0));
  solids.push_back(box(Vec3(2.0, -1.0, 0.0), Vec3(2.1, 1.0, 4.0)));
  const auto check = FlightCheck::from_solids(solids).value();
  const auto verdict = check.judge(straight(Vec3(0, 0, 2), Vec3(4, 0, 2))).value();
  EXPECT_TRUE(verdict.touched);
  EXPECT_NEAR(verdict.clearance_t_s, (2.0 - 0.15) / 4.0 * 2.0, 0.01);
}

// The body's own surface as many points, each at its distance from the pillar.
TEST(Solids, TiltedBodiesNearPillarsAgreeWithDenseSampling) {
  Random random(4);
  double worst_m = 0.0;
  for (int k = 0; k < 400; ++k) {
    const Solid solid = pillar(0.0, 0.0, random.uniform(0.2, 1.5), random.uniform(1.0, 6.0));
    const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double reach = solid.size_m.x() / 2.0 + 0.16 + random.uniform(0.0, 1.0);
    const Vec3 place(reach * std::cos(angle), reach * std::sin(angle), random.uniform(0.2, 7.0));
    const Quaternion tilt(Eigen::AngleAxisd(random.uniform(0.0, 1.2),
                                            Vec3(std::cos(3.0 * k), std::sin(3.0 * k), 0.0)));
    double sampled_m = 1e9;
    for (int side = -1; side <= 1; side += 2) {
      for (int i = 0; i < 720; ++i) {
        const double a = i * std::numbers::pi / 360.0;
        for (const double r : {0.05, 0.1, 0.15}) {
          const Vec3 rim(r * std::cos(a), r * std::sin(a), side * 0.05);
          sampled_m = std::min(sampled_m, distance_m(solid, place + tilt * rim));
        }
      }
    }
    const auto check = FlightCheck::from_solids(std::vector{solid}, kCylinderBody).value();
    const auto verdict = check.judge(std::vector{Sample{0.0, place, tilt}}).value();
    const double judged_m = verdict.touched ? 0.0 : verdict.clearance_m;
    EXPECT_LE(judged_m, sampled_m + 2e-5) << k;  // the samples lie on the body
    worst_m = std::max(worst_m, sampled_m - judged_m);
  }
  // Between two samples the body comes nearer by their spacing at the most.
  EXPECT_LT(worst_m, 0.05);
}

TEST(Solids, BadSolidsAreRefused) {
  EXPECT_EQ(FlightCheck::from_solids({}).error().code, ErrorCode::map_empty);
  const auto code = [](const Solid& solid) {
    return FlightCheck::from_solids(std::vector{solid}).error().code;
  };
  EXPECT_EQ(code(pillar(std::nan(""), 0, 1, 1)), ErrorCode::invalid_input);
  EXPECT_EQ(code(pillar(0, 0, 0, 1)), ErrorCode::invalid_input);
  EXPECT_EQ(code({.size_m = Vec3(1, 2, 1)}), ErrorCode::invalid_input);
  EXPECT_EQ(code(box(Vec3(1, 1, 1), Vec3(0, 2, 2))), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::flight_check
