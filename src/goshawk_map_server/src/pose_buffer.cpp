#include "goshawk/map_server/pose_buffer.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace goshawk::map_server {
namespace {

constexpr std::int64_t kReordered_ns = 100'000'000;  // so late a datagram may come after its follower

double seconds(std::int64_t ns) {
  return 1e-9 * double(ns);
}

}  // namespace

PoseBuffer::PoseBuffer(std::string_view what, double kept_s, double max_gap_s)
    : what_(what),
      kept_ns_(std::int64_t(1e9 * kept_s)),
      max_gap_ns_(std::int64_t(1e9 * max_gap_s)) {}

Status PoseBuffer::add(std::int64_t stamp_ns, const Pose& pose) {
  if (stamp_ns <= 0) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the stamp of {} is zero: clouds cannot be placed without it", what_));
  }
  if (!poses_.empty() && stamp_ns == newest_ns()) {
    poses_.back().pose = pose;
    return success();
  }
  if (!poses_.empty() && stamp_ns < newest_ns()) {
    if (stamp_ns >= newest_ns() - kReordered_ns) return success();
    const double back_s = seconds(newest_ns() - stamp_ns);
    poses_.clear();
    poses_.push_back({stamp_ns, pose});
    return fail(ErrorCode::clock_set,
                fmt::format("the stamp of {} jumped back by {:.3g} s: poses from before are "
                            "forgotten, and clouds from before are not placed",
                            what_, back_s));
  }
  poses_.push_back({stamp_ns, pose});
  // Erased in batches: the cost a pose is constant.
  const std::size_t old = first_not_before(stamp_ns - kept_ns_);
  if (old > 64 && 2 * old > poses_.size()) {
    poses_.erase(poses_.begin(), poses_.begin() + std::ptrdiff_t(old));
  }
  return success();
}

std::size_t PoseBuffer::first_not_before(std::int64_t stamp_ns) const {
  const auto found = std::ranges::lower_bound(poses_, stamp_ns, {}, &Stamped::stamp_ns);
  return std::size_t(found - poses_.begin());
}

Result<Pose> PoseBuffer::at(std::int64_t stamp_ns) const {
  if (stamp_ns <= 0) {
    return fail(ErrorCode::invalid_input,
                "the stamp of a cloud is zero: the driver must tell when it was measured");
  }
  if (empty()) {
    return fail(ErrorCode::tracking_lost,
                fmt::format("a cloud came before any pose of {}, so its sensor's place is not "
                            "known",
                            what_));
  }
  if (stamp_ns < oldest_ns()) {
    return fail(ErrorCode::tracking_lost,
                fmt::format("a cloud is stamped {:.3g} s before the oldest pose of {} that is "
                            "kept: check its latency, and whether both come from one clock",
                            seconds(oldest_ns() - stamp_ns), what_));
  }
  if (stamp_ns > newest_ns()) {
    return fail(ErrorCode::tracking_lost,
                fmt::format("a cloud is stamped {:.3g} s after the newest pose of {}: check "
                            "whether poses still come, and whether both come from one clock",
                            seconds(stamp_ns - newest_ns()), what_));
  }
  const std::size_t next = first_not_before(stamp_ns);
  const Stamped& b = poses_[next];
  if (b.stamp_ns == stamp_ns) return b.pose;
  const Stamped& a = poses_[next - 1];
  const std::int64_t gap = b.stamp_ns - a.stamp_ns;
  if (gap > max_gap_ns_) {
    return fail(ErrorCode::tracking_lost,
                fmt::format("a cloud falls into a gap of {:.3g} s without a pose of {}",
                            seconds(gap), what_));
  }
  const double share = double(stamp_ns - a.stamp_ns) / double(gap);
  return Pose{a.pose.position + share * (b.pose.position - a.pose.position),
              a.pose.q.slerp(share, b.pose.q)};
}

void PoseBuffer::positions(std::int64_t from_ns, std::int64_t to_ns,
                           std::vector<Vec3>& path) const {
  path.clear();
  for (std::size_t i = first_not_before(from_ns + 1); i < poses_.size(); ++i) {
    if (poses_[i].stamp_ns > to_ns) break;
    path.push_back(poses_[i].pose.position);
  }
}

}  // namespace goshawk::map_server
