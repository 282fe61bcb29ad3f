// Flights into worlds that nobody knows before they are seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "count_of.hpp"
#include "goshawk/closed_loop/flight_lab.hpp"
#include "growing_world.hpp"
#include "unfolding_world.hpp"

namespace goshawk::goals {
namespace {

using closed_loop::FlightLab;

constexpr double kScan_s = 0.05;
constexpr double kLongest_s = 90.0;
const Vec3 kHome(1.1, 5.1, 1.5), kGoal(18.9, 5.1, 1.5);

navigator::Config optimistic(double v_max_m_s = 2.0, double a_max_m_s2 = 2.0) {
  navigator::Config config;
  config.v_max_m_s = v_max_m_s;
  config.a_max_m_s2 = a_max_m_s2;
  config.unknown = UnknownSpace::free;
  return config;
}

worlds::World made(const char* kind, double density, std::uint64_t seed) {
  worlds::WorldSpec spec;
  spec.kind = kind;
  spec.size_m = Vec3(20.0, 10.0, 3.0);
  spec.density = density;
  spec.seed = seed;
  spec.keep_free = {kHome, kGoal};
  return worlds::make_world(spec).value();
}

closed_loop::Setup setup_of(const navigator::Config& config, double move_within_m) {
  closed_loop::Setup setup;
  setup.navigator = config;
  setup.planning.search.move_within_m = move_within_m;
  setup.home_map = kHome;
  return setup;
}

/// A vehicle with a sensor in a world; what it is to fly is checked at every millisecond.
struct Flight {
  Flight(const worlds::World& made, std::uint64_t seed, const navigator::Config& config,
         double range_m = 6.0, double move_within_m = 0.0)
      : world(made, range_m),
        lab((world.see_from(kHome), world.map()), seed, setup_of(config, move_within_m)) {
    lab.set_truth(world.truth());
    lab.watch = [this] { look(); };
  }

  void look() {
    if (lab.now_s() >= next_scan_s && sees) {
      next_scan_s += kScan_s;
      if (world.see_from(lab.position())) lab.set_map(world.map());
    }
    fastest_m_s = std::max(fastest_m_s, lab.speed());
    const Vec3 reference = lab.tracker().status().reference.position;
    unseen += body_was_seen_free(*world.map(), reference) ? 0 : 1;
  }

  UnfoldingWorld world;
  FlightLab lab;
  bool sees = true;
  double next_scan_s = 0.0;
  double fastest_m_s = 0.0;
  int unseen = 0;  // milliseconds in which the reference is in space that was not seen to be free
};

void expect_safe(const Flight& flight) {
  EXPECT_EQ(flight.lab.contacts(), 0);
  EXPECT_EQ(flight.unseen, 0);
  EXPECT_LT(flight.lab.max_error_m(), kTrackingMargin_m);
  for (const Error& refusal : flight.lab.refusals) ADD_FAILURE() << refusal.message;
  for (const Error& loss : flight.lab.losses) ADD_FAILURE() << loss.message;
}

TEST(Unfolding, AGoalInUnseenSpaceIsReachedAndNothingUnseenIsFlownThrough) {
  const int flights = count_of("GOSHAWK_UNFOLDING", 3);
  double flown_s = 0.0, fastest_m_s = 0.0;
  int commits = 0, plans = 0;
  for (int seed = 1; seed <= flights; ++seed) {
    SCOPED_TRACE(seed);
    Flight flight(made(seed % 2 ? "forest" : "boxes", 0.1 + 0.05 * (seed % 3), std::uint64_t(seed)),
                  std::uint64_t(seed), optimistic());
    const double begin_s = flight.lab.now_s();
    ASSERT_TRUE(flight.lab.goal(kGoal));
    flight.lab.run(kLongest_s, [&] { return flight.lab.settled(); });
    EXPECT_EQ(flight.lab.state().state, navigator::State::arrived)
        << flight.lab.state().reason.message;
    expect_safe(flight);
    std::printf("%d: %.1f s, %d plans, %d commits\n", seed, flight.lab.now_s() - begin_s,
                flight.lab.plans(), flight.lab.commits());
    flown_s += flight.lab.now_s() - begin_s;
    fastest_m_s = std::max(fastest_m_s, flight.fastest_m_s);
    commits += flight.lab.commits();
    plans += flight.lab.plans();
  }
  std::printf("%d flights, %.1f s each, fastest %.2f m/s, %d plans, %d commits\n", flights,
              flown_s / flights, fastest_m_s, plans, commits);
}

/// The middle of an obstacle that nobody has seen yet, 0.3 m from free space at the most.
Vec3 inside_a_trunk(const VoxelGrid& truth) {
  const Index3 size = truth.geometry.size;
  for (int x = size.x - 20; x > size.x / 2; --x) {
    for (int y = 10; y < size.y - 10; ++y) {
      const Index3 at{x, y, 7};
      if (truth.raw.get(at) && !truth.raw.get({x - 1, y, 7})) return truth.geometry.center(at);
    }
  }
  throw std::logic_error("the world has no trunk");
}

TEST(Unfolding, AGoalThatTurnsOutToLieInAnObstacleIsRefusedWithItsReason) {
  Flight flight(made("forest", 0.15, 31), 31, optimistic());
  ASSERT_TRUE(flight.lab.goal(inside_a_trunk(*flight.world.truth())));
  flight.lab.run(kLongest_s, [&] { return flight.lab.settled(); });
  EXPECT_EQ(flight.lab.state().state, navigator::State::failed);
  EXPECT_EQ(flight.lab.state().reason.code, ErrorCode::goal_occupied);
  EXPECT_LT(flight.lab.speed(), 0.1);
  expect_safe(flight);
}

TEST(Unfolding, AGoalThatTurnsOutToLieInAnObstacleIsMovedIfItMayBe) {
  constexpr double kMove_m = 0.8;
  Flight flight(made("forest", 0.15, 31), 31, optimistic(), 6.0, kMove_m);
  const Vec3 goal = inside_a_trunk(*flight.world.truth());
  ASSERT_TRUE(flight.lab.goal(goal));
  flight.lab.run(kLongest_s, [&] { return flight.lab.settled(); });
  EXPECT_EQ(flight.lab.state().state, navigator::State::arrived)
      << flight.lab.state().reason.message;
  EXPECT_NE(flight.lab.state().reason.message.find("as the search moved it"), std::string::npos);
  EXPECT_LT((flight.lab.position() - goal).norm(), kMove_m + 0.1);
  expect_safe(flight);
}

/// A hall with a U of walls, 8 m deep, that is open towards the vehicle; the goal lies behind it.
worlds::World dead_end() {
  GridGeometry geometry{.resolution_m = 0.2, .size = {100, 50, 15}};
  worlds::World world{geometry, BitGrid(geometry.size, true, false)};
  for (int z = 0; z < 15; ++z) {
    for (int i = 0; i < 40; ++i) {
      world.occupied.set({40 + i, 15, z}, true);
      world.occupied.set({40 + i, 35, z}, true);
    }
    for (int y = 15; y <= 35; ++y) world.occupied.set({80, y, z}, true);
  }
  return world;
}

TEST(Unfolding, ADeadEndIsLeftByTheMemoryOfTheMap) {
  Flight flight(dead_end(), 5, optimistic());
  ASSERT_TRUE(flight.lab.goal(kGoal));
  flight.lab.run(kLongest_s, [&] { return flight.lab.settled(); });
  EXPECT_EQ(flight.lab.state().state, navigator::State::arrived)
      << flight.lab.state().reason.message;
  expect_safe(flight);
}

// Whatever of the planning dies, and whether or not scans still come.
TEST(Unfolding, WithoutPlansTheVehicleComesToRestInSpaceThatWasSeenFree) {
  const int flights = count_of("GOSHAWK_UNFOLDING", 3);
  Random random(3);
  for (int seed = 1; seed <= flights; ++seed) {
    SCOPED_TRACE(seed);
    Flight flight(made("forest", 0.15, std::uint64_t(seed) + 50), std::uint64_t(seed),
                  optimistic());
    ASSERT_TRUE(flight.lab.goal(kGoal));
    flight.lab.run(random.uniform(0.5, 8.0), [&] { return flight.lab.settled(); });
    flight.lab.let_planning(false);
    flight.sees = random.chance(0.5);
    flight.lab.run(20.0, [&] { return !flight.lab.moves(); });
    EXPECT_LT(flight.lab.speed(), 0.1);
    expect_safe(flight);
    if (flight.lab.state().state == navigator::State::arrived) continue;
    flight.lab.let_planning(true);
    flight.sees = true;
    flight.lab.run(kLongest_s, [&] { return flight.lab.settled(); });
    if (flight.lab.state().state == navigator::State::failed) {
      ASSERT_TRUE(flight.lab.goal(kGoal));
      flight.lab.run(kLongest_s, [&] { return flight.lab.settled(); });
    }
    EXPECT_EQ(flight.lab.state().state, navigator::State::arrived);
    expect_safe(flight);
  }
}

}  // namespace
}  // namespace goshawk::goals
