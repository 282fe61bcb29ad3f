#pragma once

#include <functional>
#include <optional>

#include "goshawk/core/vehicle.hpp"
#include "nav_msgs.h"
#include "tally.hpp"

namespace goshawk::conformance {

/// Stands in for the vehicle and the navigator: flies the tracker's commands (with a point mass
/// that follows thrust and attitude at once, in real time), commits good and bad trajectories, and
/// judges the commands by the flight.
class TrackerExaminer {
 public:
  TrackerExaminer(runtime::Context& context, const Options& options);

  /// @param recorded trajectories that are flown beside the generated one
  Result<Report> examine(const std::vector<goshawk_msgs::msg::CommittedTrajectory>& recorded);

 private:
  static constexpr double kBegins_in_s = 0.3;  // [s] from the commit to the start
  using Committed = goshawk_msgs::msg::CommittedTrajectory;

  struct Flight {
    bool accepted = false, followed = false, holds = false;
    std::string said;      // in the last report
    double worst_m = 0.0;  // largest distance from the reference
    double left_m = 0.0;   // distance from the end when it is over
    double gap_s = 0.0;    // longest time without odometry or commands
    bool arrived() const { return holds && left_m <= 0.1; }
    bool good() const { return accepted && followed && arrived(); }
  };

  /// Flies on for at most timeout_s, or until done(). @return done()
  bool live(double timeout_s, const std::function<bool()>& done);
  void move();
  void send_odometry();
  void take(const goshawk_msgs::msg::AttitudeSetpoint& m, std::int64_t received_ns);
  void send_map(bool blocked_above);
  void settle_map();
  void weigh();
  /// @return [ns] when it begins
  std::int64_t commit(Committed committed, double begins_in_s);
  /// Flies to the start of the next flight. @return whether it arrived
  bool fly_to(const Vec3& position);
  Flight fly(const Committed& committed);
  Flight fly_undisturbed(const std::function<Committed()>& make);
  /// A straight flight that begins where the vehicle is.
  Committed straight(const Vec3& by, double duration_s);
  /// @param make the trajectory, from where the vehicle is then
  void examine_flight(const std::string& name, const std::function<Committed()>& make);
  void examine_bad();
  void examine_bad_odometry();
  void examine_garbage();
  void examine_silence();

  const Options& options_;
  runtime::Node node_;
  ReportListener listener_;
  runtime::Publisher<nav_msgs::msg::Odometry> odometry_;
  runtime::Publisher<Committed> commits_;
  runtime::Publisher<goshawk_msgs::msg::VoxelGrid> maps_;
  std::uint64_t map_version_ = 0;  // of the newest map
  Report report_;

  RigidBodyState vehicle_;
  double weight_n_ = 0.0;      // thrust in hover; 0: not measured yet
  std::int64_t moved_ns_ = 0;  // when the vehicle's state was true
  std::int64_t next_ns_ = 0;   // of the next odometry
  std::optional<AttitudeSetpoint> command_;
  int commands_ = 0;
  std::int64_t commanded_ns_ = 0;  // when the newest command came
  double longest_gap_s_ = 0.0;     // of odometry or commands, since a flight began
  std::uint64_t id_ = 1000;
  goshawk_msgs::msg::TrackingState state_;
  Tally valid_{"commands are finite, stamped, of unit attitude"};
  std::vector<double> latencies_s_;
};

}  // namespace goshawk::conformance
