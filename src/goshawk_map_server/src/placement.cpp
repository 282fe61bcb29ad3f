#include "goshawk/map_server/placement.hpp"

#include <algorithm>

namespace goshawk::map_server {
namespace {

constexpr std::int64_t kSlice_ns = 500'000;

Result<Pose> pose_at(std::int64_t stamp_ns, const FrameTree::Chain& to_base,
                     const PoseBuffer& odometry) {
  const auto base = odometry.at(stamp_ns);
  if (!base) return base.error();
  const auto sensor = to_base.at(stamp_ns);
  if (!sensor) return sensor.error();
  return *base * *sensor;
}

}  // namespace

TimeSpan time_span(const SensorCloud& cloud) {
  if (cloud.offsets_ns.empty()) return {cloud.stamp_ns, cloud.stamp_ns};
  const auto [least, most] = std::ranges::minmax(cloud.offsets_ns);
  return {cloud.stamp_ns + least, cloud.stamp_ns + most};
}

Status place(const SensorCloud& cloud, const FrameTree::Chain& to_base, const PoseBuffer& odometry,
             PlacedCloud& placed) {
  placed.points_map.clear();
  placed.origins_map.clear();
  const TimeSpan span = time_span(cloud);
  const auto first = pose_at(span.first_ns, to_base, odometry);
  if (!first) return first.error();
  const bool one_moment = span.first_ns == span.last_ns;
  if (one_moment) placed.origins_map.push_back(first->position);

  // A slice is looked up when its first point comes: its middle, or the end of all.
  const auto slices = std::size_t((span.last_ns - span.first_ns) / kSlice_ns) + 1;
  std::vector<std::optional<Pose>> poses(slices);
  if (one_moment) poses[0] = *first;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    std::size_t slice = 0;
    if (!one_moment) {
      slice = std::size_t((cloud.stamp_ns + cloud.offsets_ns[i] - span.first_ns) / kSlice_ns);
    }
    if (!poses[slice]) {
      const std::int64_t middle_ns =
          span.first_ns + std::int64_t(slice) * kSlice_ns + kSlice_ns / 2;
      const auto pose = pose_at(std::min(middle_ns, span.last_ns), to_base, odometry);
      if (!pose) return pose.error();
      poses[slice] = *pose;
    }
    const Pose& pose = *poses[slice];
    placed.points_map.push_back(pose * cloud.points[i]);
    if (!one_moment) placed.origins_map.push_back(pose.position);
  }
  return success();
}

}  // namespace goshawk::map_server
