#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "goshawk/closed_loop/planning.hpp"
#include "goshawk/closed_loop/vehicle.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/navigator/navigator.hpp"
#include "goshawk/tracker/tracker.hpp"

namespace goshawk::closed_loop {

/// How long messages and plans take. Drawn anew for each plan.
struct Delays {
  double plan_min_s = 0.002;
  double plan_max_s = 0.015;
  double late_share = 0.0;  // of the plans, that take up to late_s
  double late_s = 0.5;
  /// Where set, a plan takes what this says in addition, and the planning stages begin the next
  /// one only then: a slow planner flies as it would.
  Stopwatch stopwatch = {};
};

/// What a plan took [s].
struct Replan {
  Planning::Times stages;
  double check_s = 0.0;  // of its answer, in the navigator: stop part and proof
  double all_s() const { return stages.all_s() + check_s; }
};

/// What is flown, and how.
struct Setup {
  navigator::Config navigator = {};
  tracker::Config tracker = {};
  simulator::Config vehicle = {};
  Planning::Config planning = {};
  Tracking tracking = Tracking::physical;
  Delays delays = {};
  Vec3 home_map = Vec3(3.0, 0.0, 1.0);  // [m] where the vehicle hovers at first
};

/// All stages' cores, the tracker and a vehicle in one thread and simulated time: a flight of a
/// second takes milliseconds, and equal seeds give equal flights (unless a stopwatch measures).
class FlightLab {
 public:
  /// @pre the setup's configurations are valid (throws else)
  FlightLab(std::shared_ptr<const VoxelGrid> map, std::uint64_t seed, const Setup& setup = {});

  /// From here on all stages have this map.
  void set_map(std::shared_ptr<const VoxelGrid> map);
  const std::shared_ptr<const VoxelGrid>& map() const { return map_; }

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
  std::int64_t now_ns() const { return vehicle_->time_ns(); }
  double now_s() const { return double(now_ns()) * 1e-9; }
  const RigidBodyState& vehicle() const { return vehicle_->state(); }  // the truth
  const Vec3& position() const { return vehicle().position_map; }
  const Vec3& velocity() const { return vehicle().velocity_map; }
  double speed() const { return velocity().norm(); }
  bool moves() const { return tracker_.status().mode != tracker::Mode::hold; }
  const navigator::StateOrder& state() const { return state_; }
  bool settled() const {
    return state_.state == navigator::State::arrived || state_.state == navigator::State::failed;
  }

  int plans() const { return plans_; }
  int commits() const { return commits_; }
  /// What each plan took; only with a stopwatch.
  const std::vector<Replan>& replans() const { return replans_; }
  int contacts() const { return contacts_; }  // milliseconds in which the body touches
  double max_error_m() const { return max_error_m_; }
  double max_speed_m_s() const { return max_speed_m_s_; }
  std::vector<Error> refusals;  // of the tracker
  std::vector<Error> losses;    // of trajectories, by the tracker
  std::vector<Error> failures;  // of plans

  /// Called after each millisecond.
  std::function<void()> watch;
  /// Called for each commit that the tracker has taken.
  std::function<void(const CommittedTrajectory&)> on_commit;

  /// In so many seconds of simulated time.
  void in(double seconds, std::function<void()> act);

 private:
  struct Event {
    std::int64_t time_ns;
    std::function<void()> act;
  };
  void step();
  void exchange(std::int64_t now_ns);
  void take_orders();
  void obey(const PlanRequest& request);
  void obey(const navigator::Commit& commit);
  void obey(const navigator::Complaint&) {}
  void obey(const navigator::StateOrder& state) { state_ = state; }
  void answer(const PlanRequest& request, Planning::Answer planned);
  double delay_s(double computed_s);
  double timed_s(const std::function<void()>& work);
  void report_tracker();

  Setup setup_;
  std::shared_ptr<const VoxelGrid> map_;
  std::shared_ptr<const VoxelGrid> truth_;
  bool planning_lives_ = true;
  Random random_;
  Planning planning_;
  std::unique_ptr<Vehicle> vehicle_;
  tracker::Tracker tracker_;
  navigator::Navigator navigator_;
  navigator::StateOrder state_;
  std::deque<Event> events_;
  std::optional<CommittedTrajectory> flown_;
  std::string reported_;
  std::uint64_t answers_ = 0;
  std::int64_t busy_until_ns_ = 0;  // the planning stages
  int plans_ = 0;
  int commits_ = 0;
  std::vector<Replan> replans_;
  int contacts_ = 0;
  double max_error_m_ = 0.0;
  double max_speed_m_s_ = 0.0;
};

}  // namespace goshawk::closed_loop
