#pragma once

#include <algorithm>
#include <cmath>

#include "goshawk/core/random.hpp"
#include "goshawk/flight_report/flight.hpp"

namespace goshawk::flight_report::test {

/// A world of pillars and low boxes, and a two-leg tour over it that was flown with a small error.
/// Made by hand: what matters here is how it looks and reads, not whether it is safe.
struct SampleFlight {
  VoxelGrid obstacles;
  VoxelGrid grown;
  Flight flight;

  explicit SampleFlight(Index3 size = {40, 30, 20}, double resolution_m = 0.2, int columns = 25) {
    obstacles.geometry = {Vec3::Zero(), resolution_m, size};
    obstacles.grown = BitGrid(size, true);
    Random random(4);
    for (int k = 0; k < columns; ++k) add_column(random, size);
    grown = obstacles;
    grown.grown = grow(obstacles.grown);
    const Vec3 end = obstacles.geometry.upper_corner_map();
    add_leg({0.1 * end.x(), 0.15 * end.y(), 0.3 * end.z()},
            {0.9 * end.x(), 0.8 * end.y(), 0.6 * end.z()}, 0.5);
    add_leg({0.9 * end.x(), 0.8 * end.y(), 0.6 * end.z()},
            {0.3 * end.x(), 0.85 * end.y(), 0.4 * end.z()},
            flight.legs[0].trajectory.duration_s() + 1.0);
    fly();
    flight.title = "A tour of two legs";
    flight.obstacles = &obstacles;
    flight.grown = &grown;
  }
  SampleFlight(const SampleFlight&) = delete;  // the flight points into this

 private:
  void add_column(Random& random, Index3 size) {
    const int x = random.below(size.x), y = random.below(size.y), edge = 1 + random.below(3);
    const int height = random.chance(0.5) ? size.z : 2 + random.below(size.z / 2);
    for (int z = 0; z < height; ++z) {
      for (int j = y; j < std::min(size.y, y + edge); ++j) {
        obstacles.grown.set_run(x, std::min(size.x, x + edge), j, z, true);
      }
    }
  }

  static BitGrid grow(const BitGrid& occupied) {
    BitGrid result = occupied;
    const Index3 size = occupied.size();
    for (int z = 0; z < size.z; ++z) {
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          if (!occupied.get({x, y, z})) continue;
          for (int dz = -1; dz <= 1; ++dz) {
            for (int dy = -1; dy <= 1; ++dy) {
              for (int dx = -1; dx <= 1; ++dx) {
                const Index3 i{x + dx, y + dy, z + dz};
                if (result.contains(i)) result.set(i, true);
              }
            }
          }
        }
      }
    }
    return result;
  }

  static Polytope around(const Vec3& a, const Vec3& b) {
    Polytope box = Polytope::box(a.cwiseMin(b).array() - 0.5, a.cwiseMax(b).array() + 0.5);
    const Vec3 slant = Vec3(1.0, -1.0, 0.3).normalized();
    box.add(slant, std::max(slant.dot(a), slant.dot(b)) + 0.4);
    box.add(-slant, -std::min(slant.dot(a), slant.dot(b)) + 0.4);
    return box;
  }

  void add_leg(const Vec3& from, const Vec3& to, double start_t_s) {
    constexpr int kSegments = 4;
    Leg leg;
    leg.start_t_s = start_t_s;
    leg.yaw_curve = YawCurve{1.5, {0.0, 0.5, 1.5, 1.0}};
    std::vector<FlatState> joints(kSegments + 1);
    const double segment_s = (to - from).norm() / kSegments / 1.4;
    for (int k = 0; k <= kSegments; ++k) {
      const Vec3 swing(0.0, 0.6 * std::sin(2.0 * k), 0.2 * std::sin(3.0 * k));
      joints[std::size_t(k)].position =
          from + (to - from) * k / kSegments + (k % kSegments == 0 ? Vec3(Vec3::Zero()) : swing);
      leg.waypoints_map.push_back(joints[std::size_t(k)].position);
      if (k % kSegments != 0) joints[std::size_t(k)].velocity = (to - from).normalized() * 1.6;
    }
    for (std::size_t k = 0; k < kSegments; ++k) {
      const Vec3 a = leg.waypoints_map[k], b = leg.waypoints_map[k + 1];
      leg.trajectory.pieces.push_back(BezierPiece::between(joints[k], joints[k + 1], segment_s));
      leg.trajectory.pieces.back().polytope = int(k);
      leg.corridor.push_back(around(a, b));
      for (int i = 0; i < 8; ++i)
        leg.raw_path_map.push_back(a + (b - a) * i / 8.0 + Vec3(0, 0.1 * (i % 2), 0));
    }
    leg.raw_path_map.push_back(to);
    flight.legs.push_back(std::move(leg));
  }

  void fly() {
    const Leg& last = flight.legs.back();
    const double end_s = last.start_t_s + last.trajectory.duration_s() + 0.5;
    for (double t_s = 0.5; t_s <= end_s; t_s += 0.01) {
      const auto state = flight.planned_at(t_s);
      const Vec3 error(0.02 * std::sin(3.0 * t_s), 0.02 * std::cos(2.0 * t_s), 0.01);
      flight.flown.push_back({t_s, state->position + error, state->velocity,
                              Eigen::Quaterniond(Eigen::AngleAxisd(0.1, Vec3::UnitX()))});
    }
  }
};

}  // namespace goshawk::flight_report::test
