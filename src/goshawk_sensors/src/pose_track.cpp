#include "goshawk/sensors/pose_track.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::sensors {

PoseTrack::PoseTrack(double max_gap_s, double keep_s)
    : max_gap_ns_(std::llround(max_gap_s * 1e9)), keep_ns_(std::llround(keep_s * 1e9)) {}

Status PoseTrack::add(std::int64_t stamp_ns, const Pose& pose) {
  if (!is_finite(pose.position_map) || !pose.q_map_base.coeffs().allFinite()) {
    return fail(ErrorCode::invalid_input, "a pose of the vehicle is not finite");
  }
  if (!entries_.empty() && stamp_ns <= entries_.back().stamp_ns) entries_.clear();
  if (!entries_.empty()) {
    Entry& before = entries_.back();
    Quaternion turn = before.pose.q_map_base.conjugate() * pose.q_map_base;
    if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
    const double sine = turn.vec().norm();
    before.angle_rad = 2.0 * std::atan2(sine, turn.w());
    if (sine > 0.0) before.axis_base = turn.vec() / sine;
  }
  entries_.push_back({stamp_ns, pose});
  while (entries_.front().stamp_ns < stamp_ns - keep_ns_ && entries_.size() > 2) {
    entries_.pop_front();
  }
  last_found_ = 0;
  return success();
}

std::optional<Pose> PoseTrack::at(std::int64_t time_ns) const {
  if (entries_.empty() || time_ns < first_ns() || time_ns > last_ns()) return std::nullopt;
  if (entries_.size() == 1) return entries_.front().pose;
  // Times come in order, mostly: the entry of the last call is near.
  const bool before = entries_[last_found_].stamp_ns > time_ns;
  if (before || entries_[std::min(last_found_ + 1, entries_.size() - 1)].stamp_ns < time_ns) {
    const auto after =
        std::upper_bound(entries_.begin(), entries_.end(), time_ns,
                         [](std::int64_t t, const Entry& e) { return t < e.stamp_ns; });
    last_found_ = std::size_t(after - entries_.begin()) - 1;
  }
  last_found_ = std::min(last_found_, entries_.size() - 2);
  const Entry& a = entries_[last_found_];
  const Entry& b = entries_[last_found_ + 1];
  const std::int64_t gap_ns = b.stamp_ns - a.stamp_ns;
  if (gap_ns > max_gap_ns_ && time_ns != a.stamp_ns && time_ns != b.stamp_ns) return std::nullopt;
  const double s = double(time_ns - a.stamp_ns) / double(gap_ns);
  const Eigen::AngleAxisd turn(s * a.angle_rad, a.axis_base);
  return Pose{a.pose.position_map + s * (b.pose.position_map - a.pose.position_map),
              (a.pose.q_map_base * Quaternion(turn)).normalized()};
}

}  // namespace goshawk::sensors
