#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "goshawk/map_server/sensor_check.hpp"

namespace goshawk::map_server {
namespace {

constexpr std::size_t kMostClouds = 30, kMostPoints = 800;          // of a cloud
constexpr double kBodyReach_m = SensorCheckOptions{}.body_reach_m;  // nearer points may turn along
constexpr double kLeastTurn_rad = 0.5;
constexpr double kFirstStep_rad = 0.04, kLastStep_rad = 0.0025;
constexpr double kSuspicious_rad = 0.01, kSuspiciousShare = 0.03;

struct PlacedPart {
  std::vector<Vec3> points;  // in the sensor's frame
  Pose base;
};

Quaternion turn_of(const Vec3& roll_pitch_yaw) {
  return Quaternion(Eigen::AngleAxisd(roll_pitch_yaw.z(), Vec3::UnitZ()) *
                    Eigen::AngleAxisd(roll_pitch_yaw.y(), Vec3::UnitY()) *
                    Eigen::AngleAxisd(roll_pitch_yaw.x(), Vec3::UnitX()));
}

std::vector<PlacedPart> placed_parts(const std::vector<RecordedCloud>& clouds,
                                     const PoseBuffer& odometry) {
  std::vector<PlacedPart> parts;
  const std::size_t skip = std::max<std::size_t>(1, clouds.size() / kMostClouds);
  for (std::size_t i = 0; i < clouds.size(); i += skip) {
    const SensorCloud& cloud = clouds[i].cloud;
    const auto base = odometry.at(cloud.stamp_ns);
    if (!base) continue;
    PlacedPart part{{}, *base};
    const std::size_t stride = std::max<std::size_t>(1, cloud.points.size() / kMostPoints);
    for (std::size_t k = 0; k < cloud.points.size(); k += stride) {
      if (cloud.points[k].norm() > kBodyReach_m) part.points.push_back(cloud.points[k]);
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

double turned_rad(const std::vector<PlacedPart>& parts) {
  double most = 0.0;
  for (const PlacedPart& part : parts) {
    most = std::max(most, part.base.q.angularDistance(parts.front().base.q));
  }
  return most;
}

std::uint64_t key_of(const Eigen::Array3d& voxels) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    key = key << 21 | (std::uint64_t(std::int64_t(std::floor(voxels[axis]))) & 0x1FFFFF);
  }
  return key;
}

// Of two rasters, half a voxel apart: in one alone, a wall on the faces of voxels fills two layers.
std::size_t voxels_filled(const std::vector<PlacedPart>& parts, const Pose& to_base,
                          const Vec3& correction_rad, double resolution_m) {
  const Quaternion turn = turn_of(correction_rad);
  std::unordered_set<std::uint64_t> whole, half;
  whole.reserve(parts.size() * kMostPoints);
  half.reserve(parts.size() * kMostPoints);
  for (const PlacedPart& part : parts) {
    const Pose sensor = part.base * Pose{to_base.position, to_base.q * turn};
    for (const Vec3& p : part.points) {
      const Eigen::Array3d at = ((sensor * p) / resolution_m).array();
      whole.insert(key_of(at));
      half.insert(key_of(at + 0.5));
    }
  }
  return whole.size() + half.size();
}

}  // namespace

Result<MountReport> check_mount(const std::vector<RecordedCloud>& clouds, const Pose& to_base,
                                const PoseBuffer& odometry, double resolution_m) {
  const std::vector<PlacedPart> parts = placed_parts(clouds, odometry);
  if (parts.size() < 5) {
    return fail(
        ErrorCode::tracking_lost,
        fmt::format("only {} of the clouds have odometry around their stamps", parts.size()));
  }
  if (const double turned = turned_rad(parts); turned < kLeastTurn_rad) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the vehicle turned by {:.2f} rad only: errors of the mount show if it "
                            "turns by {:.1f} rad and more while it moves",
                            turned, kLeastTurn_rad));
  }
  MountReport report;
  const std::size_t at_first = voxels_filled(parts, to_base, Vec3::Zero(), resolution_m);
  std::size_t best = at_first;
  for (double step = kFirstStep_rad; step >= kLastStep_rad; step *= 0.5) {
    for (bool better = true; better;) {
      better = false;
      for (int axis = 0; axis < 3; ++axis) {
        for (const double by : {step, -step}) {
          Vec3 tried = report.correction_rad;
          tried[axis] += by;
          const std::size_t filled = voxels_filled(parts, to_base, tried, resolution_m);
          if (filled >= best) continue;
          best = filled;
          report.correction_rad = tried;
          better = true;
        }
      }
    }
  }
  report.thinner_share = 1.0 - double(best) / double(at_first);
  report.suspicious =
      report.thinner_share > kSuspiciousShare && report.correction_rad.norm() > kSuspicious_rad;
  return report;
}

}  // namespace goshawk::map_server
