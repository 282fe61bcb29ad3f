#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/worlds/world.hpp"
#include "whole_stack.hpp"

// The certificate is about the map: what our own planner makes is flown, what goes through an
// obstacle is not, and what appears in flight is braked for. Judged by brute force on raw voxels.

namespace goshawk::whole_stack {
namespace {

constexpr double kLongestFlight_s = 40.0;

/// How many flights; GOSHAWK_FLIGHTS in the environment flies more of them.
int flights_or(int usual) {
  const char* wish = std::getenv("GOSHAWK_FLIGHTS");
  return wish == nullptr ? usual : std::max(1, std::atoi(wish));
}

World random_world(std::uint64_t seed, double density) {
  worlds::WorldSpec spec;
  spec.size_m = Vec3(8.0, 8.0, 4.0);
  spec.density = density;
  spec.seed = seed;
  auto made = worlds::make_world(spec);
  EXPECT_TRUE(made) << made.error().message;
  return {made->geometry, made->occupied};
}

/// Straight through whatever there is, from rest to rest, certified against a polytope of its own.
CommittedTrajectory forged(const Vec3& from, const Vec3& to, std::int64_t start_ns,
                           std::uint64_t map_version) {
  const double duration_s = std::max(5.0 * (to - from).norm() / 2.0, 2.0);
  Trajectory trajectory{{BezierPiece::between({.position = from}, {.position = to}, duration_s)}};
  auto certified = certify(std::move(trajectory),
                           {Polytope::box(Vec3::Constant(-100.0), Vec3::Constant(100.0))},
                           {.v_max_m_s = 3.0, .a_max_m_s2 = 6.0}, {.position = from},
                           {.position = to});
  EXPECT_TRUE(certified) << certified.error().message;
  return CommittedTrajectory::make({.id = 1'000'000,
                                    .nominal = *std::move(certified),
                                    .start_time_ns = start_ns,
                                    .map_version = map_version})
      .value();
}

/// Does a straight line enter a blocked voxel, seen at many points of it?
bool enters_blocked(const World& world, const Vec3& from, const Vec3& to) {
  for (int i = 0; i <= 4000; ++i) {
    const auto voxel = world.grid()->geometry.index_of(from + i / 4000.0 * (to - from));
    if (!voxel || world.grid()->grown.get(*voxel)) return true;
  }
  return false;
}

TEST(MapPromise, PlansOfOurOwnAreNeverRefusedNorBrakedForInFlight) {
  int commits = 0;
  for (int seed = 1; seed <= flights_or(10); ++seed) {
    SCOPED_TRACE(seed);
    World world = random_world(std::uint64_t(seed), 0.1 + 0.1 * (seed % 4));
    Random random{std::uint64_t(seed)};
    Stack stack(world, world.free_place(random), std::uint64_t(seed));
    for (int k = 0; k < 6; ++k) {
      stack.go_to(world.free_place(random));
      stack.run(random.uniform(0.3, 2.5));
    }
    stack.run_until_done(kLongestFlight_s);
    for (const Error& refusal : stack.refusals) {
      EXPECT_NE(refusal.code, ErrorCode::trajectory_blocked) << refusal.message;
    }
    for (const Error& fault : stack.faults) {
      EXPECT_NE(fault.code, ErrorCode::trajectory_blocked) << fault.message;
    }
    commits += stack.commits;
  }
  std::printf("%d plans, none blocked\n", commits);
  EXPECT_GT(commits, 2 * flights_or(10));
}

TEST(MapPromise, ForgedTrajectoriesThroughObstaclesAreAlwaysRefused) {
  int refused = 0;
  for (int seed = 1; seed <= flights_or(10); ++seed) {
    SCOPED_TRACE(seed);
    World world = random_world(std::uint64_t(seed) + 5000, 0.3);
    Random random{std::uint64_t(seed)};
    const Vec3 start = world.free_place(random);
    Stack stack(world, start, std::uint64_t(seed));
    for (int k = 0; k < 40; ++k) {
      const Vec3 end = world.free_place(random);
      if (!enters_blocked(world, start, end)) continue;
      const std::uint64_t version = random.chance(0.5) ? 1 : 0;
      const Status answer =
          stack.tracker.accept(forged(start, end, stack.now_ns(), version), stack.now_ns());
      EXPECT_EQ(answer.code(), ErrorCode::trajectory_blocked);
      ++refused;
    }
    stack.run(1.0);
    EXPECT_LT((stack.vehicle.state().position_map - start).norm(), 0.05);
  }
  std::printf("%d forged trajectories, all refused\n", refused);
  EXPECT_GT(refused, 10 * flights_or(10));
}

/// An obstacle that appears in the vehicle's way, or near it, yet so far that it can stop.
std::optional<Index3> obstacle_ahead(const Stack& stack, const World& world, Random& random) {
  if (!stack.flown || stack.tracker.status().mode != tracker::Mode::follow) return {};
  const Trajectory& flown = stack.flown->flown();
  const double now_s = stack.tracker.status().progress_s;
  const double then_s = random.uniform(now_s, flown.duration_s());
  Vec3 place = flown.sample(then_s).position;
  for (int axis = 0; axis < 3; ++axis) place[axis] += random.uniform(-0.3, 0.3);
  const auto voxel = world.grid()->geometry.index_of(place);
  if (!voxel) return {};
  // Within reach of the hardest stop, its shortest duration and the margin nothing appears.
  const double speed = stack.vehicle.state().velocity_map.norm();
  const double reach_m = kBodyRadius_m + 2.0 * kMargin_m + 0.45 * speed +
                         world.grid()->geometry.resolution_m;
  const Vec3 vehicle = stack.vehicle.state().position_map;
  const Vec3 centre = world.grid()->geometry.center(*voxel);
  const double half_diagonal = world.grid()->geometry.resolution_m * std::sqrt(3.0) / 2.0;
  if ((centre - vehicle).norm() - half_diagonal < reach_m) return {};
  return voxel;
}

TEST(MapPromise, ObstaclesThatAppearInFlightAreNeverTouched) {
  int appeared = 0, braked = 0;
  double nearest_m = 1.0, fastest_m_s = 0.0, error_m = 0.0;
  for (int seed = 1; seed <= flights_or(15); ++seed) {
    SCOPED_TRACE(seed);
    World world = random_world(std::uint64_t(seed) + 9000, 0.1 + 0.05 * (seed % 3));
    Random random{std::uint64_t(seed)};
    Stack stack(world, world.free_place(random), std::uint64_t(seed));
    const auto judge = [&] {
      const Vec3 p = stack.vehicle.state().position_map;
      const double distance_m = world.distance_m(p, 0.5);
      nearest_m = std::min(nearest_m, distance_m);
      fastest_m_s = std::max(fastest_m_s, stack.vehicle.state().velocity_map.norm());
      ASSERT_GT(distance_m, kBodyRadius_m) << "touches at " << to_text(p) << " m";
    };
    for (int leg = 0; leg < 4; ++leg) {
      stack.go_to(world.free_place(random));
      for (int k = 0; k < 8; ++k) {
        stack.run(random.uniform(0.05, 0.8), judge);
        const auto voxel = obstacle_ahead(stack, world, random);
        if (!voxel) continue;
        world.add(*voxel);
        ++appeared;
        stack.tell_map();
      }
      stack.run_until_done(kLongestFlight_s, judge);
    }
    for (const Error& fault : stack.faults) {
      braked += fault.code == ErrorCode::trajectory_blocked ? 1 : 0;
    }
    error_m = std::max(error_m, stack.max_error_m);
    if (HasFatalFailure()) return;
  }
  std::printf("%d obstacles appeared, %d times braked for; nearest %.3f m, fastest %.2f m/s, "
              "largest tracking error %.4f m\n",
              appeared, braked, nearest_m, fastest_m_s, error_m);
  EXPECT_GT(appeared, 2 * flights_or(15));
  EXPECT_GT(braked, flights_or(15) / 2);
}

}  // namespace
}  // namespace goshawk::whole_stack
