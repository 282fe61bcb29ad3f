// Flights into worlds that nobody knows before they are seen, by the map that a lidar with noise
// makes: voxels at the surface of obstacles come and go.
#include <gtest/gtest.h>

#include <cstdio>

#include "count_of.hpp"
#include "flight_lab.hpp"
#include "growing_world.hpp"
#include "sensed_world.hpp"

namespace goshawk::goals {
namespace {

constexpr double kLongestNoisy_s = 90.0;
const Vec3 kFrom(1.1, 5.1, 1.5), kTo(14.9, 5.1, 1.5);

/// Where the world's voxels lie against those of the map, and how well it is seen.
struct Noisy {
  Vec3 shift_m;
  Sensing sensing;
};

worlds::World shifted(const char* kind, std::uint64_t seed, const Vec3& shift_m) {
  worlds::WorldSpec spec;
  spec.kind = kind;
  spec.size_m = Vec3(16.0, 10.0, 3.0);
  spec.origin_m = shift_m;
  spec.density = 0.15;
  spec.inflation_m = 0.6;  // room for the reserve, and for a voxel of noise
  spec.seed = seed;
  spec.keep_free = {kFrom, kTo};
  return worlds::make_world(spec).value();
}

/// All of one flight.
struct NoisyFlight {
  NoisyFlight(const char* kind, const Noisy& noisy, std::uint64_t seed)
      : world(shifted(kind, seed, noisy.shift_m), noisy.sensing),
        lab(world.map(), seed, {}, config(), kFrom) {
    lab.set_truth(world.truth());
    lab.watch = [this] {
      if (world.sense(lab.vehicle(), lab.now_ns())) lab.set_map(world.map());
    };
    lab.run(0.5);  // what is around the vehicle is seen
  }

  static navigator::Config config() {
    navigator::Config config;
    config.unknown = UnknownSpace::free;
    return config;
  }

  bool fly(const Vec3& goal) {
    if (!lab.goal(goal)) return false;
    lab.run(kLongestNoisy_s, [&] { return lab.settled(); });
    return lab.state().state == navigator::State::arrived;
  }

  SensedWorld world;
  FlightLab lab;
};

// There and back: on the way back the map is known, with all its noise.
TEST(Noisy, GoalsAreReachedWhereverWallsLieInTheirVoxels) {
  const int flights = count_of("GOSHAWK_NOISY", 4);
  int arrived = 0, losses = 0;
  double flown_s = 0.0;
  for (int i = 0; i < flights; ++i) {
    Random random(std::uint64_t(i) + 1);
    const double voxels = 0.25 * (i % 4);  // walls on faces of voxels, and within voxels
    const Noisy noisy{.shift_m = 0.2 * voxels * Vec3(1, 1, 1),
                      .sensing = {.range_noise_m = i % 3 == 0 ? 0.03 : 0.01, .seed = i + 1}};
    const char* kind = i % 2 == 0 ? "boxes" : "forest";
    SCOPED_TRACE(testing::Message() << i << ' ' << kind << ", shifted by " << voxels << " voxels");
    NoisyFlight flight(kind, noisy, std::uint64_t(i) + 1);
    const double begin_s = flight.lab.now_s();
    const bool there = flight.fly(kTo);
    EXPECT_TRUE(there) << flight.lab.state().reason.message;
    const bool back = there && flight.fly(kFrom);
    EXPECT_TRUE(!there || back) << flight.lab.state().reason.message;
    arrived += (there ? 1 : 0) + (back ? 1 : 0);
    losses += int(flight.lab.losses.size());
    flown_s += flight.lab.now_s() - begin_s;
    EXPECT_EQ(flight.lab.contacts(), 0);
    EXPECT_LT(flight.lab.max_error_m(), kTrackingMargin_m);
    std::printf("%d: %s, %.2f voxels, %.0f cm: %.1f s, %d plans, %d commits, %zu losses\n", i, kind,
                voxels, 100.0 * noisy.sensing.range_noise_m, flight.lab.now_s() - begin_s,
                flight.lab.plans(), flight.lab.commits(), flight.lab.losses.size());
    for (const Error& loss : flight.lab.losses) std::printf("   %s\n", loss.message.c_str());
  }
  std::printf("%d flights: %d of %d goals, %d losses, %.1f s each\n", flights, arrived, 2 * flights,
              losses, flown_s / flights);
}

}  // namespace
}  // namespace goshawk::goals
