// The published dynamic worlds, against the numbers of the worlds as they were shipped.
#include "goshawk/movers/league_movers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace goshawk::movers {
namespace {

int count_of(const std::vector<Mover>& movers, const std::string& kind) {
  return int(std::ranges::count(movers, kind, &Mover::kind));
}

TEST(LeagueMovers, TheFirstCubeIsTheShippedOne) {
  const auto movers = make_league_movers({}).value();
  const auto& cube = std::get<Trefoil>(movers.front().motion);
  EXPECT_TRUE(cube.center_map.isApprox(Vec3(85.2201, 3.0955, 2.1823), 1e-5));
  EXPECT_TRUE(cube.scale_m.isApprox(Vec3(2.5178, 3.0225, 2.8099), 1e-4));
  EXPECT_NEAR(cube.offset_rad, 2.3514, 1e-4);
  EXPECT_NEAR(cube.divisor_s, 4.6066, 1e-4);
  EXPECT_EQ(movers.front().half_m, Vec3::Constant(0.4));
}

TEST(LeagueMovers, KindsAreDividedAsPublished) {
  const int published[][4] = {{50, 32, 7, 11}, {100, 65, 13, 22}, {200, 130, 25, 45}};
  for (const auto& [count, cubes, pillars, bars] : published) {
    const auto movers = make_league_movers({.count = count}).value();
    EXPECT_EQ(count_of(movers, "cube"), cubes);
    EXPECT_EQ(count_of(movers, "pillar"), pillars);
    EXPECT_EQ(count_of(movers, "bar"), bars);
    EXPECT_EQ(make_league_movers({.count = count, .still = false})->size(), std::size_t(cubes));
  }
}

// Reference: 0.772 m/s on average with divisors of 4 to 6 s, at most 1.78 m/s.
TEST(LeagueMovers, SpeedsAreThosePublished) {
  double sum = 0.0, most = 0.0;
  int n = 0;
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    for (const Mover& m :
         make_league_movers({.count = 200, .seed = seed, .still = false}).value()) {
      for (int i = 0; i < 50; ++i, ++n) {
        const double speed = m.at(0.6 * i).velocity_map.norm();
        sum += speed, most = std::max(most, speed);
        EXPECT_LE(speed, m.top_speed_m_s());
      }
    }
  }
  EXPECT_NEAR(sum / n, 0.772, 0.02);
  EXPECT_NEAR(most, 1.7, 0.1);
}

TEST(LeagueMovers, AMeanSpeedMayBeGiven) {
  const auto movers = make_league_movers({.count = 10, .speed_m_s = 2.0, .still = false}).value();
  for (const Mover& m : movers) {
    const auto& trefoil = std::get<Trefoil>(m.motion);
    EXPECT_NEAR(trefoil.length_m() / (2.0 * std::numbers::pi * trefoil.divisor_s), 2.0, 1e-9);
  }
}

TEST(LeagueMovers, WhatCannotBeIsRefused) {
  EXPECT_EQ(make_league_movers({.count = 0}).code(), ErrorCode::invalid_input);
  EXPECT_EQ(make_league_movers({.count = 20'000}).code(), ErrorCode::invalid_input);
  EXPECT_EQ(make_league_movers({.divisor_min_s = 0.0}).code(), ErrorCode::invalid_input);
  EXPECT_EQ(make_league_movers({.divisor_min_s = 1e-9}).code(), ErrorCode::invalid_input);
  EXPECT_EQ(make_league_movers({.speed_m_s = std::nan("")}).code(), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::movers
