#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "goshawk/flight_check/flight_check.hpp"
#include "goshawk/guard/guard.hpp"
#include "goshawk/simulator/quadrotor.hpp"
#include "goshawk/tracker/tracker.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::guarded {

/// A true world, and the map of what is within a sensor's range of where the vehicle was.
class SeenWorld {
 public:
  /// @param range_m infinity: all is known at once
  SeenWorld(const worlds::World& world, double range_m);
  /// @return whether the map is another one now
  bool see_from(const Vec3& p_map);
  const std::shared_ptr<const VoxelGrid>& map() const { return map_; }
  const worlds::World& truth() const { return world_; }

 private:
  worlds::World world_;
  double range_m_;
  BitGrid known_, raw_;
  std::uint64_t version_ = 0;
  std::shared_ptr<const VoxelGrid> map_;
};

/// Guard, tracker and vehicle in one thread and simulated time. Plans come from outside, by
/// messages that take their time; the flight is judged by FCL in the true world.
class GuardLab {
 public:
  GuardLab(const worlds::World& world, double range_m, const Vec3& home_map,
           const guard::Config& config = {});

  /// Flies on for so long. @param tick called every 20 ms
  void run(
      double seconds, const std::function<void()>& tick = [] {});
  /// It reaches the guard after `delay_s`.
  void send(guard::Plan plan, double delay_s);

  std::int64_t now_ns() const { return vehicle_.time_ns(); }
  const Vec3& position() const { return vehicle_.state().position_map; }
  const Vec3& velocity() const { return vehicle_.state().velocity_map; }
  const SeenWorld& world() const { return world_; }

  /// What FCL says of all that was flown so far, in the world as it is.
  flight_check::Verdict judge() const;

  std::vector<guard::Decision> decisions = {};
  std::vector<CommittedTrajectory> commits = {};
  std::vector<Error> refusals = {};  // of commits, by the tracker
  std::vector<Error> losses = {};    // of what was flown, by the tracker
  double max_error_m = 0.0;          // of tracking
  double max_speed_m_s = 0.0;
  double travelled_m = 0.0;

 private:
  void step();
  void control(std::int64_t now_ns);
  void in(double seconds, std::function<void()> act);
  void take_commits();

  SeenWorld world_;
  simulator::Quadrotor vehicle_;
  tracker::Tracker tracker_;
  guard::Guard guard_;
  struct Event {
    std::int64_t time_ns;
    std::function<void()> act;
  };
  std::deque<Event> events_;
  std::uint64_t lost_id_ = 0;
  std::vector<flight_check::Sample> track_;
};

}  // namespace goshawk::guarded
