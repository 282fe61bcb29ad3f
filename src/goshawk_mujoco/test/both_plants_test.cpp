#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "goshawk/core/random.hpp"
#include "goshawk/mujoco/mujoco_plant.hpp"
#include "goshawk/simulator/quadrotor.hpp"
#include "goshawk/tracker/tracker.hpp"

namespace goshawk::mujoco {
namespace {

using simulator::Quadrotor;

// A round through five places, with 2 m/s and 2 m/s^2 at the most.
CommittedTrajectory round_trip(std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> places{{0, 0, 1}};
  for (int k = 0; k < 4; ++k) {
    places.push_back(places.back() + Vec3(random.uniform(-1.5, 1.5), random.uniform(0.5, 1.5),
                                          random.uniform(-0.3, 0.5)));
  }
  Trajectory trajectory;
  for (std::size_t k = 1; k < places.size(); ++k) {
    const double duration_s = 1.6 * std::sqrt((places[k] - places[k - 1]).norm() * 5.77 / 2.0);
    trajectory.pieces.push_back(
        BezierPiece::between({.position = places[k - 1]}, {.position = places[k]}, duration_s));
  }
  const FlatState start{.position = places.front()}, goal{.position = places.back()};
  auto certified =
      certify(std::move(trajectory), {Polytope::box(Vec3::Constant(-50.0), Vec3::Constant(50.0))},
              {.v_max_m_s = 10.0, .a_max_m_s2 = 10.0}, start, goal);
  return CommittedTrajectory::make(
             {.id = seed, .nominal = std::move(certified).value(), .start_time_ns = 1'000'000'000})
      .value();
}

struct Flown {
  std::vector<RigidBodyState> states;  // every millisecond
  double rms_error_m = 0.0;
  double max_error_m = 0.0;
};

Flown fly(const simulator::Config& config, const plant::PlantFactory& plant,
          const CommittedTrajectory& committed) {
  auto vehicle = Quadrotor::create(config, plant).value();
  tracker::Config tracking;
  tracking.max_tilt_rad = 1.2;
  tracking.min_thrust_n = 0.5;
  tracking.require_map = false;
  auto tracker = tracker::Tracker::create(tracking).value();
  EXPECT_TRUE(vehicle.reset(committed.nominal().start().position, 0.0));
  Flown flown;
  const double duration_s = committed.flown().duration_s() + 2.0;
  for (int ms = 0; ms < int(1000.0 * duration_s); ++ms) {
    if (ms % 4 == 0) {
      const auto command = tracker.step(vehicle.state(), vehicle.time_ns());
      EXPECT_TRUE(command) << command.error().message;
      EXPECT_TRUE(vehicle.command(*command));
      if (ms == 0) {
        EXPECT_TRUE(tracker.accept(committed, 0));
      }
    }
    EXPECT_TRUE(vehicle.advance(0.001));
    flown.states.push_back(vehicle.state());
  }
  const auto status = tracker.status();
  EXPECT_EQ(status.fault.code, ErrorCode::ok) << status.fault.message;
  flown.rms_error_m = status.rms_error_m;
  flown.max_error_m = status.max_error_m;
  return flown;
}

struct Difference {
  double position_m = 0.0;
  double tilt_rad = 0.0;
};

Difference largest(const Flown& a, const Flown& b) {
  Difference d;
  for (std::size_t i = 0; i < std::min(a.states.size(), b.states.size()); ++i) {
    d.position_m =
        std::max(d.position_m, (a.states[i].position_map - b.states[i].position_map).norm());
    d.tilt_rad =
        std::max(d.tilt_rad, a.states[i].q_map_base.angularDistance(b.states[i].q_map_base));
  }
  return d;
}

Difference compare(const simulator::Config& config) {
  Difference worst;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto committed = round_trip(seed);
    const auto ours = fly(config, simulator::make_rigid_body, committed);
    const auto theirs = fly(config, make_mujoco_plant, committed);
    const auto d = largest(ours, theirs);
    worst.position_m = std::max(worst.position_m, d.position_m);
    worst.tilt_rad = std::max(worst.tilt_rad, d.tilt_rad);
    EXPECT_NEAR(ours.max_error_m, theirs.max_error_m, 1e-3);
    EXPECT_LT(theirs.rms_error_m, 0.02);
    EXPECT_LT(theirs.max_error_m, 0.06);
  }
  testing::Test::RecordProperty("position_m", std::to_string(worst.position_m));
  testing::Test::RecordProperty("tilt_rad", std::to_string(worst.tilt_rad));
  return worst;
}

// The same equations of motion, so what is left is integration: MuJoCo's is of first order, with a
// local error of a h^2 / 2 in each of its half-millisecond steps; under feedback that does not add
// up. Wind and its learning change nothing of that.
TEST(BothPlants, TheSameFlightDiffersByLessThanHalfAMillimetre) {
  const auto difference = compare({});
  EXPECT_LT(difference.position_m, 5e-4);
  EXPECT_LT(difference.tilt_rad, 2e-3);
  EXPECT_GT(difference.position_m, 0.0);  // they are two
}

TEST(BothPlants, SoItDoesInWindAndGusts) {
  simulator::Config config;
  config.wind_x_m_s = 2.0;
  config.gust_deviation_m_s = 0.7;
  const auto difference = compare(config);
  EXPECT_LT(difference.position_m, 5e-4);
  EXPECT_LT(difference.tilt_rad, 2e-3);
}

TEST(BothPlants, EachRepeatsBitForBit) {
  for (const auto& plant :
       {plant::PlantFactory(simulator::make_rigid_body), plant::PlantFactory(make_mujoco_plant)}) {
    simulator::Config config;
    config.gust_deviation_m_s = 0.7;
    config.sensor.position_noise_m = 0.002;
    const auto a = fly(config, plant, round_trip(3)), b = fly(config, plant, round_trip(3));
    ASSERT_EQ(a.states.size(), b.states.size());
    for (std::size_t i = 0; i < a.states.size(); ++i) {
      ASSERT_EQ(a.states[i].position_map, b.states[i].position_map);
      ASSERT_EQ(a.states[i].q_map_base.coeffs(), b.states[i].q_map_base.coeffs());
    }
  }
}

}  // namespace
}  // namespace goshawk::mujoco
