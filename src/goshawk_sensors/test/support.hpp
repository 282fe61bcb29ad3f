#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/random.hpp"
#include "goshawk/sensors/sensor.hpp"
#include "goshawk/sensors/voxel_world.hpp"

namespace goshawk::sensors {

constexpr double kPi = std::numbers::pi;

/// Each voxel is occupied with this probability.
inline BitGrid random_voxels(Index3 size, double share, Random& random) {
  BitGrid grid(size, false);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) grid.set({x, y, z}, random.chance(share));
    }
  }
  return grid;
}

inline Vec3 random_direction(Random& random) {
  while (true) {
    Vec3 v;
    for (int a = 0; a < 3; ++a) v[a] = random.uniform(-1.0, 1.0);
    if (v.norm() > 0.1 && v.norm() <= 1.0) return v.normalized();
  }
}

inline Vec3 random_point(Random& random, const Vec3& lower, const Vec3& upper) {
  Vec3 v;
  for (int a = 0; a < 3; ++a) v[a] = random.uniform(lower[a], upper[a]);
  return v;
}

inline Hit cast_one(const World& world, const Ray& ray) {
  Hit hit;
  world.cast({&ray, 1}, {&hit, 1});
  return hit;
}

/// A sphere of this radius around a point, seen from inside: every ray meets it.
class Sphere : public World {
 public:
  Sphere(const Vec3& center, double radius_m) : center_(center), radius_m_(radius_m) {}

  void cast(std::span<const Ray> rays, std::span<Hit> hits) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Vec3 o = rays[i].origin - center_;
      const double b = o.dot(rays[i].direction);
      const double range_m = -b + std::sqrt(b * b - o.squaredNorm() + radius_m_ * radius_m_);
      hits[i] = range_m <= rays[i].range_m ? Hit{range_m, 1.0} : Hit{};
    }
  }
  bool contains(const Vec3& point) const override { return (point - center_).norm() > radius_m_; }

 private:
  Vec3 center_;
  double radius_m_;
};

/// A wall without end that fills x >= x_m.
class Wall : public World {
 public:
  explicit Wall(double x_m) : x_m_(x_m) {}

  void cast(std::span<const Ray> rays, std::span<Hit> hits) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double t = (x_m_ - rays[i].origin.x()) / rays[i].direction.x();
      hits[i] = t >= 0.0 && t <= rays[i].range_m ? Hit{t, std::abs(rays[i].direction.x())} : Hit{};
    }
  }
  bool contains(const Vec3& point) const override { return point.x() > x_m_; }

 private:
  double x_m_;
};

class Nothing : public World {
 public:
  void cast(std::span<const Ray>, std::span<Hit> hits) const override {
    for (Hit& hit : hits) hit = {};
  }
  bool contains(const Vec3&) const override { return false; }
};

/// The preset without any error: no noise, no losses.
inline SensorParameters perfect(Preset preset) {
  SensorParameters p;
  apply_preset(preset, p);
  auto& r = p.returns;
  r.range_noise_m = r.range_noise_square_1_m = r.angle_noise_rad = 0.0;
  r.missing_share = r.false_share = r.edge_share = 0.0;
  p.mount = {};
  p.mount.z_m = 0.0;
  return p;
}

/// Every scan that a sensor makes of poses that do not move, within this time.
inline std::vector<Scan> scans_at_rest(Sensor& sensor, const World& world, double time_s,
                                       const Pose& pose = {}) {
  std::vector<Scan> scans;
  PoseTrack track;
  for (int i = 0; i * 0.01 <= time_s + 1e-9; ++i) {
    EXPECT_TRUE(track.add(1'000'000'000 + i * 10'000'000LL, pose));
    const auto status =
        sensor.advance(world, track, [&](const Scan& scan) { scans.push_back(scan); });
    EXPECT_TRUE(status) << status.error().message;
  }
  return scans;
}

inline bool same_bytes(const Scan& a, const Scan& b) {
  if (a.number != b.number || a.start_ns != b.start_ns || a.returns.size() != b.returns.size()) {
    return false;
  }
  for (std::size_t i = 0; i < a.returns.size(); ++i) {
    const Return &r = a.returns[i], &s = b.returns[i];
    if (r.point != s.point || r.intensity != s.intensity || r.offset_ns != s.offset_ns ||
        r.ring != s.ring || r.valid != s.valid) {
      return false;
    }
  }
  return true;
}

}  // namespace goshawk::sensors
