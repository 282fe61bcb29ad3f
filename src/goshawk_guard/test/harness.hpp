#pragma once

#include <gmock/gmock.h>

#include <memory>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/guard/guard.hpp"

namespace goshawk::guard {

inline constexpr std::int64_t kSecond = 1'000'000'000;
inline const Vec3 kHome(1.1, 0.1, 2.1);
inline constexpr double kYaw_rad = 0.5;

/// 20 x 10 x 4 m from (0, -5, 0) in voxels of 0.2 m, obstacles grown by 0.2 m.
struct MapSpec {
  double wall_x_m = 1e9;        // a wall across, two voxels thick
  double gap_y_m = 1e9;         // with a gap of 2 m around this y
  double seen_until_x_m = 1e9;  // unknown beyond
  std::uint64_t version = 7;
};
std::shared_ptr<const VoxelGrid> map_of(const MapSpec& spec);

/// Plays the tracker, which takes every commit at once, and the vehicle, which is on it.
class Harness {
 public:
  explicit Harness(const MapSpec& spec = {}, const Config& config = {});

  /// Time passes; the tracker speaks every 20 ms.
  void pass(double seconds);
  Decision send(const Plan& plan);
  void map(const MapSpec& spec);
  Vec3 place() const { return guard.flown().at(now)->position; }
  FlatState ahead(double seconds) const {
    return *guard.flown().at(now + std::int64_t(seconds * 1e9));
  }
  const CommittedTrajectory& last() const { return commits.back(); }

  Guard guard;
  std::int64_t now = 10 * kSecond;
  std::shared_ptr<const VoxelGrid> grid;
  std::vector<CommittedTrajectory> commits;

 private:
  void take();
};

/// Of each commit, whatever led to it: its flown part begins where the vehicle is, keeps the limits
/// by dense samples, ends at rest, and is free by dense samples.
void expect_safe(const Harness& h, const CommittedTrajectory& committed, const Config& config = {});

/// A cubic uniform B-spline from rest to rest along points: as planners of the EGO family.
Plan spline_plan(const std::vector<Vec3>& points, double knot_s,
                 std::optional<std::int64_t> start_ns = {});
/// Straight and evenly spaced.
Plan straight_plan(const Vec3& from, const Vec3& to, double duration_s,
                   std::optional<std::int64_t> start_ns = {});
Plan path_plan(std::vector<Vec3> points);

}  // namespace goshawk::guard
