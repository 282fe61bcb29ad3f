#pragma once

#include <memory>
#include <optional>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/free_curve.hpp"

namespace goshawk::tracker {

/// Where the vehicle should be at any moment: at a point, on a committed trajectory, or on a curve
/// of the tracker's own that leaves it (a stop, a landing). A trajectory or curve may be told to
/// brake: that slows the time along it down to a stop, so that the reference never leaves it. A
/// function of time alone: asking changes nothing.
class Reference {
 public:
  static Reference hold(const Vec3& position_map);
  /// @param start_ns when it begins, on the tracker's clock
  static Reference follow(std::shared_ptr<const CommittedTrajectory> committed,
                          std::int64_t start_ns);

  /// From now_ns on this curve instead of what was to come. @pre ends at rest
  void leave_by(const BezierPiece& curve, std::int64_t now_ns);

  /// Come to rest on the path, from now_ns on, with the given deceleration at its peak (beside the
  /// path's own), and without a jump of the acceleration. Again while braking, or on a held point:
  /// nothing new.
  void brake(std::int64_t now_ns, double deceleration_m_s2);

  /// Before the trajectory's start: its start, moved back with the start's velocity. After its
  /// end: the end, at rest.
  FlatState at(std::int64_t time_ns) const;

  bool has_trajectory() const { return committed_ != nullptr; }
  /// On a committed trajectory, and as it was planned.
  bool follows() const { return committed_ && !curve_ && !brake_; }
  /// At rest for good: a held point, or the end of the trajectory, the curve or the braking.
  bool at_rest(std::int64_t time_ns) const;

  /// [s] until it is at rest for good; 0: it is.
  double seconds_to_rest(std::int64_t from_ns) const;

  /// Is what is left of it free, until it comes to rest, or until to_ns? A held point is.
  /// @return the first obstruction; its time counts from from_ns on
  std::optional<Obstruction> find_obstruction(const FreeSpace& space, std::int64_t from_ns,
                                              std::optional<std::int64_t> to_ns = {}) const;

  /// @pre has_trajectory()
  const CommittedTrajectory& committed() const { return *committed_; }
  std::int64_t start_ns() const { return start_ns_; }
  double duration_s() const { return duration_s_; }
  /// [s] how far along the trajectory's own time, in [0, duration_s()]; 0 on a held point. A curve
  /// that left it does not change that.
  double progress_s(std::int64_t time_ns) const;

 private:
  struct Brake {
    std::int64_t begin_ns;
    double path_time_s;  // where on the path it begins
    double duration_s;   // how long it takes
  };
  /// Time along the path, and its first three derivatives.
  struct PathTime {
    double s;
    double rate;
    double rate_1_s = 0.0;
    double rate_1_s2 = 0.0;
  };
  bool rests_always() const { return !committed_ && !curve_; }
  std::int64_t path_start_ns() const { return curve_ ? curve_ns_ : start_ns_; }
  double path_duration_s() const { return curve_ ? curve_->duration_s : duration_s_; }
  FlatState on_path(double time_s) const;
  PathTime path_time(std::int64_t time_ns) const;
  double seconds_until(double path_time_s, std::int64_t from_ns) const;

  Vec3 hold_map_ = Vec3::Zero();
  std::shared_ptr<const CommittedTrajectory> committed_;
  std::int64_t start_ns_ = 0;
  double duration_s_ = 0.0;  // of what is flown of it
  std::optional<BezierPiece> curve_;
  std::int64_t curve_ns_ = 0;  // when it begins
  double left_at_s_ = 0.0;     // where it left the trajectory
  std::optional<Brake> brake_;
};

}  // namespace goshawk::tracker
