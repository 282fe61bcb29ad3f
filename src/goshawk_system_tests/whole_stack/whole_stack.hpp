#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "goshawk/core/random.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/navigator/navigator.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/simulator/quadrotor.hpp"
#include "goshawk/tracker/tracker.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::whole_stack {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
inline constexpr double kBodyRadius_m = 0.15;
inline constexpr double kMargin_m = 0.05;

/// Obstacles as they are, and the map that stages make of them.
class World {
 public:
  /// @param raw obstacles
  World(const GridGeometry& geometry, BitGrid raw);

  const BitGrid& raw() const { return raw_; }
  const std::shared_ptr<const VoxelGrid>& grid() const { return grid_; }
  /// The next version of the map has this obstacle.
  void add(Index3 voxel);
  /// [m] from a point to the nearest obstacle's cube, looked for within `within_m`; the world's
  /// faces are no obstacles. By brute force, without the grown map.
  double distance_m(const Vec3& p_map, double within_m) const;
  /// A place in the middle of a free voxel.
  Vec3 free_place(Random& random) const;

 private:
  void grow();

  GridGeometry geometry_;
  BitGrid raw_;
  std::uint64_t version_ = 0;
  std::shared_ptr<const VoxelGrid> grid_;
};

/// All stages' cores, a simulated vehicle and a clock in one thread: deterministic, as a flight in
/// lock step. Odometry at 250 Hz; commands act one step later; a plan takes kPlanning_ns.
class Stack {
 public:
  Stack(World& world, const Vec3& start_map, std::uint64_t seed);

  void go_to(const Vec3& goal_map);
  /// The world has changed.
  void tell_map();
  /// @param each called after every step of 4 ms
  void run(double duration_s, const std::function<void()>& each = {});
  /// Until the navigator has arrived or failed, for that long at the most.
  void run_until_done(double most_s, const std::function<void()>& each = {});

  std::int64_t now_ns() const { return vehicle.time_ns(); }
  navigator::State state() const { return navigator.state(); }

  simulator::Quadrotor vehicle;
  tracker::Tracker tracker;
  navigator::Navigator navigator;
  /// The newest that the tracker took.
  std::optional<CommittedTrajectory> flown;
  std::vector<Error> refusals;  // of the tracker
  std::vector<Error> faults;    // it reported in flight
  int commits = 0;
  double max_error_m = 0.0;

 private:
  struct Planned {
    std::int64_t at_ns;
    std::uint64_t id;
    Result<Commitment> outcome;
    StageRole stage;
  };
  void step();
  void serve_navigator();
  void order(const PlanRequest& request);
  void order(const CommittedTrajectory& committed);
  void order(const navigator::StateOrder&) {}
  void watch_tracker();
  Result<Commitment> plan(const PlanRequest& request, StageRole& stage);

  World& world_;
  path_search::PathSearch search_;
  corridor_builder::CorridorBuilder builder_;
  trajectory_optimizer::TrajectoryOptimizer optimizer_;
  std::deque<Planned> planned_;
  std::optional<AttitudeSetpoint> command_;
  std::string said_;
  int steps_ = 0;
};

}  // namespace goshawk::whole_stack
