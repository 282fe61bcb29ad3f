#pragma once

#include <optional>

#include "goshawk/tracker/committed_trajectory.hpp"

namespace goshawk::tracker {

/// Where the vehicle should be at any moment: at a point, or on a trajectory, which may be told to
/// brake or to stop. Braking slows the time along the path down to a stop, so that the reference
/// never leaves the certified curve: for a vehicle that is where it should be. A stop is a curve of
/// its own, from where the vehicle is to rest. A function of time alone: asking changes nothing.
class Reference {
 public:
  static Reference hold(const Vec3& position_map);
  /// @pre admit(committed) ok
  static Reference follow(CommittedTrajectory committed);

  /// Come to rest on the path, from now_ns on, at about the given deceleration. Again while
  /// braking, or on a held point: nothing new.
  void brake(std::int64_t now_ns, double deceleration_m_s2);

  /// Come to rest by this curve, from now_ns on, instead of what was to come. @pre ends at rest
  void stop(const BezierPiece& curve, std::int64_t now_ns);

  /// Before the trajectory's start: its start, moved back with the start's velocity. After its
  /// end: the end, at rest.
  FlatState at(std::int64_t time_ns) const;

  bool has_trajectory() const { return committed_.has_value(); }
  bool braking() const { return brake_.has_value() || stop_.has_value(); }
  /// At rest for good: a held point, or the end of the trajectory, the braking or the stop.
  bool at_rest(std::int64_t time_ns) const;

  /// @pre has_trajectory()
  const CommittedTrajectory& committed() const { return *committed_; }
  double duration_s() const { return duration_s_; }
  /// [s] how far along the trajectory's own time, in [0, duration_s()]; 0 on a held point. A stop
  /// leaves it as it was.
  double progress_s(std::int64_t time_ns) const;

 private:
  struct Brake {
    std::int64_t begin_ns;
    double path_time_s;  // where on the path it begins
    double duration_s;   // how long it takes
  };
  struct Stop {
    std::int64_t begin_ns;
    double path_time_s;
    BezierPiece curve;
  };
  /// Time along the path, and its first two derivatives.
  struct PathTime {
    double s;
    double rate;
    double rate_1_s;
  };
  PathTime path_time(std::int64_t time_ns) const;

  Vec3 hold_map_ = Vec3::Zero();
  std::optional<CommittedTrajectory> committed_;
  std::optional<Brake> brake_;
  std::optional<Stop> stop_;
  double duration_s_ = 0.0;
};

}  // namespace goshawk::tracker
