// Rays among things that move: each meets them where they are when it is fired.
#include "goshawk/sensors/moving_world.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/random.hpp"
#include "goshawk/sensors/sensor.hpp"
#include "goshawk/sensors/solid_world.hpp"

namespace goshawk::sensors {
namespace {

movers::Mover slider(double reach_m, double period_s) {
  return {.half_m = Vec3(0.5, 0.5, 1.0),
          .motion = movers::Slide{Vec3(5, 0, 1), Vec3(0, reach_m, 0), period_s}};
}

std::vector<movers::Mover> many(Random& random) {
  std::vector<movers::Mover> movers;
  const auto place = [&](double most) {
    const double x = random.uniform(-most, most), y = random.uniform(-most, most);
    return Vec3(x, y, random.uniform(-most, most));
  };
  for (int i = 0; i < 20; ++i) {
    movers::Mover m{.half_m = Vec3::Constant(0.6) + place(0.4)};
    if (i % 2 == 0) {
      m.motion = movers::Turn{place(6.0), place(1.0).normalized(), place(2.0), 0.0, 2.0};
    } else {
      m.motion = movers::Trefoil{place(6.0), Vec3(2, 3, 4), 1.0, 1.0};
    }
    movers.push_back(m);
  }
  return movers;
}

// Truth: a world of solids that stand where the movers are at the ray's time.
TEST(MovingWorld, EveryRaySeesTheSolidsOfItsOwnTime) {
  Random random(3);
  const auto movers = many(random);
  constexpr std::int64_t kStart_ns = 1'000'000'000;
  const MovingWorld world(movers, kStart_ns);
  std::vector<Ray> rays(3000);
  std::vector<Hit> hits(rays.size());
  for (Ray& ray : rays) {
    const Vec3 to(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    ray = {Vec3(random.uniform(-9, 9), random.uniform(-9, 9), 0.0), to.normalized(),
           random.uniform(2.0, 20.0), kStart_ns + std::int64_t(random.below(2'000'000'000))};
  }
  world.cast(rays, hits);
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::vector<Solid> solids;
    for (const auto& m : movers) {
      const auto box = m.box_at(1e-9 * double(rays[i].time_ns - kStart_ns));
      solids.push_back({Solid::Kind::box, box.center_map, box.q_map_box, box.half_m});
    }
    Hit truth;
    SolidWorld::create(solids)->cast({&rays[i], 1}, {&truth, 1});
    EXPECT_EQ(hits[i].any(), truth.any()) << i;
    if (!truth.any()) continue;
    ++met;
    EXPECT_NEAR(hits[i].range_m, truth.range_m, 1e-9) << i;
    EXPECT_NEAR(hits[i].cosine, truth.cosine, 1e-9) << i;
  }
  EXPECT_GT(met, 50);
}

TEST(MovingWorld, NoRaysAndNoMoversAreNoTrouble) {
  const MovingWorld empty({}, 0);
  Hit hit;
  const Ray ray{Vec3::Zero(), Vec3::UnitX(), 10.0};
  empty.cast({&ray, 1}, {&hit, 1});
  EXPECT_FALSE(hit.any());
  MovingWorld({slider(1.0, 2.0)}, 0).cast({}, {});
}

// A box that crosses the view at several metres a second is drawn slanted by a lidar that takes its
// time: each point lies on the box as it was at that point's time.
TEST(MovingWorld, PointsOfAScanLieOnTheMoverAtTheirOwnTimes) {
  SensorParameters p;
  p.pattern = {.pattern = Pattern::spinning, .rate_hz = 10.0, .channels = 8, .columns = 600};
  p.returns = {.range_min_m = 0.1, .range_max_m = 30.0, .range_noise_m = 0.0};
  Sensor sensor = Sensor::create(p).value();
  const movers::Mover box = slider(3.0, 2.0);
  const MovingWorld world({box}, 0);
  PoseTrack track;
  ASSERT_TRUE(track.add(10'000'000, {Vec3(0, 0, 1), Quaternion::Identity()}));
  ASSERT_TRUE(track.add(210'000'000, {Vec3(0, 0, 1), Quaternion::Identity()}));
  int points = 0;
  const auto look = [&](const Scan& scan) {
    for (const Return& r : scan.returns) {
      if (!r.valid) continue;
      ++points;
      const Vec3 p_map = Vec3(0, 0, 1) + sensor.mount().position_map + r.point.cast<double>();
      const double t_s = 1e-9 * double(scan.start_ns + r.offset_ns);
      EXPECT_LT(box.box_at(t_s).distance_m(p_map), 1e-5);
    }
  };
  ASSERT_TRUE(sensor.advance(world, track, look));
  EXPECT_GT(points, 100);
}

}  // namespace
}  // namespace goshawk::sensors
