#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "count_of.hpp"
#include "goshawk/closed_loop/flight_lab.hpp"
#include "growing_world.hpp"

// The certificate is about the map: what our own planner makes is flown, what goes through an
// obstacle is not, and what appears in flight is braked for. Judged by brute force on raw voxels.

namespace goshawk::goals {
namespace {

using closed_loop::FlightLab;

constexpr double kLongestFlight_s = 40.0;

int flights_or(int usual) {
  return count_of("GOSHAWK_FLIGHTS", usual);
}

/// Boxes and pillars. @param density share of the grown map that is blocked
GrowingWorld random_world(std::uint64_t seed, double density) {
  worlds::WorldSpec spec;
  spec.size_m = Vec3(8.0, 8.0, 4.0);
  spec.density = density;
  spec.seed = seed;
  return GrowingWorld(spec);
}

FlightLab lab_in(const GrowingWorld& world, const Vec3& start, std::uint64_t seed) {
  return {world.map(), seed, {.home_map = start}};
}

/// Straight through whatever there is, from rest to rest, certified against a polytope of its own.
CommittedTrajectory forged(const Vec3& from, const Vec3& to, std::int64_t start_ns,
                           std::uint64_t map_version) {
  const double duration_s = std::max(5.0 * (to - from).norm() / 2.0, 2.0);
  Trajectory trajectory{{BezierPiece::between({.position = from}, {.position = to}, duration_s)}};
  auto certified =
      certify(std::move(trajectory), {Polytope::box(Vec3::Constant(-100.0), Vec3::Constant(100.0))},
              {.v_max_m_s = 3.0, .a_max_m_s2 = 6.0}, {.position = from}, {.position = to});
  EXPECT_TRUE(certified) << certified.error().message;
  return CommittedTrajectory::make({.id = 1'000'000,
                                    .nominal = *std::move(certified),
                                    .start_time_ns = start_ns,
                                    .map_version = map_version})
      .value();
}

/// Does a straight line enter a blocked voxel, seen at many points of it that lie on no face?
bool enters_blocked(const GrowingWorld& world, const Vec3& from, const Vec3& to) {
  const VoxelGrid& map = *world.map();
  for (int i = 0; i <= 4000; ++i) {
    const Vec3 p = from + i / 4000.0 * (to - from);
    const Vec3 g = map.geometry.to_grid(p);
    if ((g - g.array().round().matrix()).cwiseAbs().minCoeff() < 1e-3) continue;
    const auto voxel = map.geometry.index_of(p);
    if (!voxel || map.grown.get(*voxel)) return true;
  }
  return false;
}

TEST(MapPromise, PlansOfOurOwnAreNeverRefusedNorBrakedForInFlight) {
  int commits = 0;
  for (int seed = 1; seed <= flights_or(10); ++seed) {
    SCOPED_TRACE(seed);
    GrowingWorld world = random_world(std::uint64_t(seed), 0.1 + 0.1 * (seed % 4));
    Random random{std::uint64_t(seed)};
    FlightLab lab = lab_in(world, world.free_place(random), std::uint64_t(seed));
    for (int k = 0; k < 6; ++k) {
      ASSERT_TRUE(lab.goal(world.free_place(random)));
      lab.run(random.uniform(0.3, 2.5));
    }
    lab.run(kLongestFlight_s, [&] { return lab.settled(); });
    for (const Error& refusal : lab.refusals) {
      EXPECT_NE(refusal.code, ErrorCode::trajectory_blocked) << refusal.message;
    }
    for (const Error& fault : lab.losses) {
      EXPECT_NE(fault.code, ErrorCode::trajectory_blocked) << fault.message;
    }
    commits += lab.commits();
  }
  std::printf("%d plans, none blocked\n", commits);
  EXPECT_GT(commits, 2 * flights_or(10));
}

TEST(MapPromise, ForgedTrajectoriesThroughObstaclesAreAlwaysRefused) {
  int refused = 0;
  for (int seed = 1; seed <= flights_or(10); ++seed) {
    SCOPED_TRACE(seed);
    GrowingWorld world = random_world(std::uint64_t(seed) + 5000, 0.3);
    Random random{std::uint64_t(seed)};
    const Vec3 start = world.free_place(random);
    FlightLab lab = lab_in(world, start, std::uint64_t(seed));
    for (int k = 0; k < 40; ++k) {
      const Vec3 end = world.free_place(random);
      if (!enters_blocked(world, start, end)) continue;
      const std::uint64_t version = random.chance(0.5) ? 1 : 0;
      const Status answer =
          lab.tracker().accept(forged(start, end, lab.now_ns(), version), lab.now_ns());
      EXPECT_EQ(answer.code(), ErrorCode::trajectory_blocked);
      ++refused;
    }
    lab.run(1.0);
    EXPECT_LT((lab.position() - start).norm(), 0.05);
  }
  std::printf("%d forged trajectories, all refused\n", refused);
  EXPECT_GT(refused, 10 * flights_or(10));
}

/// An obstacle that appears in the vehicle's way, or near it, yet so far that it can stop.
std::optional<Index3> obstacle_ahead(FlightLab& lab, const GrowingWorld& world, Random& random) {
  if (!lab.flown() || lab.tracker().status().mode != tracker::Mode::follow) return {};
  const Trajectory& flown = lab.flown()->flown();
  const double now_s = lab.tracker().status().progress_s;
  const double then_s = std::min(random.uniform(now_s, now_s + 4.0), flown.duration_s());
  Vec3 place = flown.sample(then_s).position;
  for (int axis = 0; axis < 3; ++axis) place[axis] += random.uniform(-0.3, 0.3);
  const auto voxel = world.map()->geometry.index_of(place);
  if (!voxel) return {};
  // Within reach of the hardest stop, its shortest duration and the margin nothing appears.
  const double speed = lab.speed();
  const double reach_m =
      kBody_m + 2.0 * kTrackingMargin_m + 0.45 * speed + world.map()->geometry.resolution_m;
  const Vec3 vehicle = lab.position();
  const Vec3 centre = world.map()->geometry.center(*voxel);
  const double half_diagonal = world.map()->geometry.resolution_m * std::sqrt(3.0) / 2.0;
  if ((centre - vehicle).norm() - half_diagonal < reach_m) return {};
  return voxel;
}

TEST(MapPromise, ObstaclesThatAppearInFlightAreNeverTouched) {
  int appeared = 0, braked = 0;
  double nearest_m = 1.0, fastest_m_s = 0.0, error_m = 0.0;
  for (int seed = 1; seed <= flights_or(15); ++seed) {
    SCOPED_TRACE(seed);
    GrowingWorld world = random_world(std::uint64_t(seed) + 9000, 0.1 + 0.05 * (seed % 3));
    Random random{std::uint64_t(seed)};
    FlightLab lab = lab_in(world, world.free_place(random), std::uint64_t(seed));
    const auto judge = [&] {
      const Vec3 p = lab.position();
      const double distance_m = obstacle_distance_m(*world.map(), p, 0.5);
      nearest_m = std::min(nearest_m, distance_m);
      fastest_m_s = std::max(fastest_m_s, lab.speed());
      ASSERT_GT(distance_m, kBody_m) << "touches at " << to_text(p) << " m";
    };
    lab.watch = judge;
    for (int leg = 0; leg < 4; ++leg) {
      ASSERT_TRUE(lab.goal(world.free_place(random)));
      for (int k = 0; k < 8; ++k) {
        lab.run(random.uniform(0.05, 0.8));
        const auto voxel = obstacle_ahead(lab, world, random);
        if (!voxel) continue;
        world.add(*voxel);
        ++appeared;
        lab.set_map(world.map());
      }
      lab.run(kLongestFlight_s, [&] { return lab.settled(); });
    }
    for (const Error& fault : lab.losses) {
      braked += fault.code == ErrorCode::trajectory_blocked ? 1 : 0;
    }
    error_m = std::max(error_m, lab.max_error_m());
    if (HasFatalFailure()) return;
  }
  std::printf(
      "%d obstacles appeared, %d times braked for; nearest %.3f m, fastest %.2f m/s, "
      "largest tracking error %.4f m\n",
      appeared, braked, nearest_m, fastest_m_s, error_m);
  EXPECT_GT(appeared, 2 * flights_or(15));
  EXPECT_GT(braked, flights_or(15) / 2);
}

}  // namespace
}  // namespace goshawk::goals
