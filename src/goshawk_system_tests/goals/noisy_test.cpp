// Flights into worlds that nobody knows before they are seen, by the map that a lidar with noise
// makes: voxels at the surface of obstacles come and go.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "count_of.hpp"
#include "goshawk/closed_loop/flight_lab.hpp"
#include "goshawk/closed_loop/live_mapper.hpp"
#include "goshawk/sensors/voxel_world.hpp"
#include "goshawk/worlds/world.hpp"
#include "growing_world.hpp"

namespace goshawk::goals {
namespace {

using closed_loop::FlightLab;
using closed_loop::LiveMapper;

constexpr double kLongestNoisy_s = 90.0;
constexpr std::int64_t kPosePeriod_ns = 4'000'000;
constexpr double kMapVoxel_m = 0.2;
const Vec3 kFrom(1.1, 5.1, 1.5), kTo(14.9, 5.1, 1.5);

/// Where the world's voxels lie against those of the map, and how well it is seen.
struct Noisy {
  const char* kind = "boxes";
  Vec3 shift_m = Vec3::Zero();
  double range_noise_m = 0.01;  // one sigma
  int seed = 1;
  double view_rad = 2.0 * std::numbers::pi;  // of the sensor, around the vehicle's x axis
};

worlds::World shifted(const Noisy& noisy) {
  worlds::WorldSpec spec;
  spec.kind = noisy.kind;
  spec.size_m = Vec3(16.0, 10.0, 3.0);
  spec.origin_m = noisy.shift_m;
  spec.density = 0.15;
  spec.inflation_m = 0.6;  // room for the reserve, and for a voxel of noise
  spec.seed = std::uint64_t(noisy.seed);
  spec.keep_free = {kFrom, kTo};
  return worlds::make_world(spec).value();
}

LiveMapper mapper(const worlds::World& world, const Noisy& noisy) {
  LiveMapper::Config config;
  sensors::SensorParameters& lidar = config.sensor;
  sensors::apply_preset(sensors::Preset::vlp16, lidar);
  lidar.pattern.channels = 64;
  lidar.pattern.columns = 240;
  lidar.pattern.elevation_lower_rad = -1.3;
  lidar.pattern.elevation_upper_rad = 1.3;
  lidar.pattern.azimuth_width_rad = noisy.view_rad;
  lidar.returns.range_min_m = 0.3;
  lidar.returns.range_max_m = 8.0;
  lidar.returns.range_noise_m = noisy.range_noise_m;
  lidar.mount.z_m = 0.0;
  lidar.seed = noisy.seed;
  // A voxel smaller than the world on each side, as the launch file live.
  const Vec3 edge = Vec3::Constant(kMapVoxel_m);
  config.box = {world.geometry.origin_map + edge, world.geometry.upper_corner_map() - edge};
  config.resolution_m = kMapVoxel_m;
  config.inflation_m = kBody_m + kTrackingMargin_m;
  config.reserve_m = kMapVoxel_m;
  config.body_radius_m = 0.35;  // what is seen neither above nor below the vehicle
  config.missing_is_free = false;
  return LiveMapper::create(config, std::make_shared<sensors::VoxelWorld>(
                                        world.geometry, world.occupied, sensors::Boundary::box))
      .value();
}

closed_loop::Setup noisy_setup() {
  closed_loop::Setup setup;
  setup.navigator.unknown = UnknownSpace::free;
  setup.planning.optimizer.yaw = trajectory_optimizer::YawMode::along_motion;
  setup.home_map = kFrom;
  return setup;
}

/// A vehicle that begins knowing nothing.
struct NoisyFlight {
  explicit NoisyFlight(const Noisy& noisy)
      : world(shifted(noisy)),
        live(mapper(world, noisy)),
        lab(live.map(), std::uint64_t(noisy.seed), noisy_setup()) {
    lab.set_truth(std::make_shared<const VoxelGrid>(VoxelGrid{
        .geometry = world.geometry, .grown = world.occupied, .known = {}, .raw = world.occupied}));
    lab.watch = [this] { look(); };
    lab.run(0.5);  // what is around the vehicle is seen
  }

  void look() {
    if (lab.now_ns() % kPosePeriod_ns != 0) return;
    const auto changed =
        live.look(lab.now_ns(), {lab.vehicle().position_map, lab.vehicle().q_map_base});
    if (!changed) throw std::logic_error(changed.error().message);
    if (*changed) lab.set_map(live.map());
  }

  bool fly(const Vec3& goal) {
    if (!lab.goal(goal)) return false;
    lab.run(kLongestNoisy_s, [&] { return lab.settled(); });
    return lab.state().state == navigator::State::arrived;
  }

  worlds::World world;
  LiveMapper live;
  FlightLab lab;
};

// There and back: on the way back the map is known, with all its noise.
TEST(Noisy, GoalsAreReachedWhereverWallsLieInTheirVoxels) {
  const int flights = count_of("GOSHAWK_NOISY", 4);
  int arrived = 0, losses = 0;
  double flown_s = 0.0;
  for (int i = 0; i < flights; ++i) {
    const double voxels = 0.25 * (i % 4);  // walls on faces of voxels, and within voxels
    const Noisy noisy{.kind = i % 2 == 0 ? "boxes" : "forest",
                      .shift_m = Vec3::Constant(kMapVoxel_m * voxels),
                      .range_noise_m = i % 3 == 0 ? 0.03 : 0.01,
                      .seed = i + 1};
    SCOPED_TRACE(testing::Message() << i << ' ' << noisy.kind << ", by " << voxels << " voxels");
    NoisyFlight flight(noisy);
    const double begin_s = flight.lab.now_s();
    const bool there = flight.fly(kTo);
    EXPECT_TRUE(there) << flight.lab.state().reason.message;
    const bool back = there && flight.fly(kFrom);
    EXPECT_TRUE(!there || back) << flight.lab.state().reason.message;
    EXPECT_EQ(flight.lab.contacts(), 0);
    EXPECT_LT(flight.lab.max_error_m(), kTrackingMargin_m);
    arrived += (there ? 1 : 0) + (back ? 1 : 0);
    losses += int(flight.lab.losses.size());
    flown_s += flight.lab.now_s() - begin_s;
    std::printf("%d: %s, %.2f voxels, %.0f cm: %.1f s, %d plans, %d commits, %zu losses\n", i,
                noisy.kind, voxels, 100.0 * noisy.range_noise_m, flight.lab.now_s() - begin_s,
                flight.lab.plans(), flight.lab.commits(), flight.lab.losses.size());
    for (const Error& loss : flight.lab.losses) std::printf("   %s\n", loss.message.c_str());
  }
  std::printf("%d flights: %d of %d goals, %d losses, %.1f s each\n", flights, arrived, 2 * flights,
              losses, flown_s / flights);
}

// It flies to what lies behind it, and back.
TEST(Noisy, AViewOf90DegreesIsEnoughBecauseTheVehicleLooksWhereItFlies) {
  NoisyFlight flight({.kind = "forest", .seed = 9, .view_rad = 0.5 * std::numbers::pi});
  EXPECT_TRUE(flight.fly(kTo)) << flight.lab.state().reason.message;
  EXPECT_TRUE(flight.fly(kFrom)) << flight.lab.state().reason.message;
  EXPECT_EQ(flight.lab.contacts(), 0);
}

}  // namespace
}  // namespace goshawk::goals
