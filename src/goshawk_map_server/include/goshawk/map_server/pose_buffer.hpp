#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::map_server {

/// A frame in another one.
struct Pose {
  Vec3 position = Vec3::Zero();  // [m]
  Quaternion q = Quaternion::Identity();

  Vec3 operator*(const Vec3& p) const { return position + q * p; }
  Pose operator*(const Pose& b) const { return {position + q * b.position, q * b.q}; }
};

/// The poses of a while, to look up the one at a moment. Times are those of the messages' stamps;
/// the clock on the wall plays no part.
class PoseBuffer {
 public:
  /// @param what for sentences: "odometry", "the transform of 'gimbal'"
  /// @param kept_s [s] older poses are forgotten @param max_gap_s [s] no pose is made up between
  /// two that are farther apart
  PoseBuffer(std::string_view what, double kept_s, double max_gap_s);

  /// A pose with the stamp of the newest takes its place; one that is up to 0.1 s older came out of
  /// order and is dropped. @return clock_set if it is older than that: all poses before are
  /// forgotten, and this one is kept; invalid_input for a stamp of zero, which is not kept
  Status add(std::int64_t stamp_ns, const Pose& pose);

  /// Interpolated: the position linearly, the attitude along the shortest arc.
  /// @return tracking_lost, with a sentence: no pose yet, the stamp older than all, newer than all,
  /// or in a gap; invalid_input for a stamp of zero
  Result<Pose> at(std::int64_t stamp_ns) const;

  bool empty() const { return poses_.empty(); }
  /// @pre not empty
  std::int64_t oldest_ns() const { return poses_.front().stamp_ns; }

  /// The positions after `from_ns` up to `to_ns`, in their order, into `path`.
  void positions(std::int64_t from_ns, std::int64_t to_ns, std::vector<Vec3>& path) const;

 private:
  struct Stamped {
    std::int64_t stamp_ns;
    Pose pose;
  };
  std::int64_t newest_ns() const { return poses_.back().stamp_ns; }
  std::size_t first_not_before(std::int64_t stamp_ns) const;

  std::string what_;
  std::int64_t kept_ns_, max_gap_ns_;
  std::vector<Stamped> poses_;  // by stamp
};

}  // namespace goshawk::map_server
