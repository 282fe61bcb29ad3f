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

namespace goshawk::goals {

/// How long messages and plans take. Drawn anew for each plan.
struct Delays {
  double plan_min_s = 0.002;
  double plan_max_s = 0.015;
  double late_share = 0.0;  // of the plans, that take up to late_s
  double late_s = 0.5;
};

/// All stages' cores, the tracker and the simulated vehicle in one thread and simulated time: a
/// flight of a second takes milliseconds, and equal seeds give equal flights.
class FlightLab {
 public:
  FlightLab(std::shared_ptr<const VoxelGrid> map, std::uint64_t seed, const Delays& delays = {},
            const navigator::Config& config = {}, const Vec3& home_map = Vec3(3, 0, 1),
            const tracker::Config& tracker_config = {});

  /// From here on all stages have this map.
  void set_map(std::shared_ptr<const VoxelGrid> map);

  /// What the vehicle touches, if the map does not show it all.
  void set_truth(std::shared_ptr<const VoxelGrid> truth) { truth_ = std::move(truth); }
  /// From here on no planning stage answers, or they do again.
  void let_planning(bool live) { planning_lives_ = live; }

  Status goal(const Vec3& goal_map) { return goal(goal_map, 0.0); }
  Status goal(const Vec3& goal_map, double yaw_rad);
  /// Until `done` or for so long. @return whether `done` came
  bool run(
      double at_most_s, const std::function<bool()>& done = [] { return false; });

  /// @return a free place that the search reaches from the first one
  Vec3 random_place();

  tracker::Tracker& tracker() { return tracker_; }
  const std::optional<CommittedTrajectory>& flown() const { return flown_; }  // newest accepted
  std::int64_t now_ns() const { return vehicle_.time_ns(); }
  const RigidBodyState& vehicle() const { return vehicle_.state(); }
  const Vec3& position() const { return vehicle_.state().position_map; }
  const Vec3& velocity() const { return vehicle_.state().velocity_map; }
  double speed() const { return velocity().norm(); }
  bool moves() const { return tracker_.status().mode != tracker::Mode::hold; }
  const navigator::StateOrder& state() const { return state_; }
  bool settled() const {
    return state_.state == navigator::State::arrived || state_.state == navigator::State::failed;
  }
  double now_s() const { return double(vehicle_.time_ns()) * 1e-9; }

  int plans() const { return plans_; }
  int commits() const { return commits_; }
  int contacts() const { return contacts_; }  // milliseconds in which the body touches
  double max_error_m() const { return max_error_m_; }
  double max_speed_m_s() const { return max_speed_m_s_; }
  std::vector<Error> refusals;  // of the tracker
  std::vector<Error> losses;    // of trajectories, by the tracker

  /// Called after each millisecond.
  std::function<void()> watch;

 private:
  struct Event {
    std::int64_t time_ns;
    std::function<void()> act;
  };
  void step();
  void in(double seconds, std::function<void()> act);
  void take_orders();
  void obey(const PlanRequest& request);
  void obey(const navigator::Commit& commit);
  void obey(const navigator::Complaint&) {}
  void obey(const navigator::StateOrder& state) { state_ = state; }
  struct Planned {
    Result<Commitment> answer;
    StageRole last;  // the stage that made it, or failed
  };
  Planned plan(const PlanRequest& request);
  void report_tracker();

  Vec3 home_map_;
  std::shared_ptr<const VoxelGrid> map_;
  std::shared_ptr<const VoxelGrid> truth_;
  bool planning_lives_ = true;
  Random random_;
  Delays delays_;
  path_search::PathSearch search_;
  corridor_builder::CorridorBuilder builder_;
  trajectory_optimizer::TrajectoryOptimizer optimizer_;
  simulator::Quadrotor vehicle_;
  tracker::Tracker tracker_;
  navigator::Navigator navigator_;
  navigator::StateOrder state_;
  std::deque<Event> events_;
  std::optional<CommittedTrajectory> flown_;
  std::string reported_;
  std::uint64_t answers_ = 0;
  int plans_ = 0;
  int commits_ = 0;
  int contacts_ = 0;
  double max_error_m_ = 0.0;
  double max_speed_m_s_ = 0.0;
};

}  // namespace goshawk::goals
