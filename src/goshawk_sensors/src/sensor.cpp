#include "goshawk/sensors/sensor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk::sensors {
namespace {

constexpr int kBatch = 512;  // rays

// A stream of random numbers for each scan: a scan that is dropped does not change the next one.
Random random_of(int seed, std::int64_t scan) {
  Random mixed{std::uint64_t(seed)};
  return Random(mixed.next() ^ (std::uint64_t(scan) * 0xD1B54A32D192ED03ULL));
}

}  // namespace

Pose mount_of(const MountParameters& m) {
  const Eigen::Quaterniond q = Eigen::AngleAxisd(m.yaw_rad, Vec3::UnitZ()) *
                               Eigen::AngleAxisd(m.pitch_rad, Vec3::UnitY()) *
                               Eigen::AngleAxisd(m.roll_rad, Vec3::UnitX());
  return {Vec3(m.x_m, m.y_m, m.z_m), Quaternion(q)};
}

Result<Sensor> Sensor::create(const SensorParameters& parameters) {
  if (auto status = check(parameters); !status) return status.error();
  return Sensor(parameters);
}

Sensor::Sensor(const SensorParameters& parameters)
    : parameters_(parameters),
      pattern_(parameters.pattern),
      model_(parameters.returns),
      body_(parameters.mount),
      mount_(mount_of(parameters.mount)),
      firings_(kBatch),
      rays_map_(kBatch),
      rays_base_(kBatch),
      hits_(kBatch),
      own_hits_(kBatch) {
  scan_.number = -1;
  scan_.returns.resize(std::size_t(pattern_.firings()));
  true_m_.resize(std::size_t(pattern_.firings()));
}

void Sensor::begin(std::int64_t start_ns) {
  ++scan_.number;
  scan_.start_ns = start_ns;
  scan_.end_ns = start_ns + pattern_.period_ns();
  random_ = random_of(parameters_.seed, scan_.number);
  const bool dropped = random_.chance(parameters_.drop_share);
  next_ = dropped ? pattern_.firings() : 0;
}

Status Sensor::advance(const World& world, const PoseTrack& track, const Done& done) {
  if (track.empty()) return success();
  placed_ns_.reset();  // a newer pose may stand beside the one in use
  // Before the first pose of the track there is nothing to see: time began anew, or begins.
  const bool anew = track.last_ns() < scan_.start_ns;
  if (!begun_ || anew) begin(track.first_ns());
  begun_ = true;
  while (true) {
    if (next_ < pattern_.firings()) {
      if (auto status = fire(world, track); !status) {
        begin(track.last_ns());
        return status;
      }
      if (next_ < pattern_.firings()) return success();
      done(scan_);
    }
    if (scan_.end_ns > track.last_ns()) return success();
    begin(scan_.end_ns);
  }
}

// All rays of the scan up to the newest pose.
Status Sensor::fire(const World& world, const PoseTrack& track) {
  while (next_ < pattern_.firings()) {
    const auto count = gather(track);
    if (!count) return count.error();
    if (*count == 0) return success();
    if (auto status = look(world, std::size_t(*count)); !status) return status;
    for (int i = 0; i < *count; ++i) record(std::size_t(i));
    next_ += *count;
  }
  return success();
}

// The next rays, at most one batch, each from where the vehicle was. @return how many
Result<int> Sensor::gather(const PoseTrack& track) {
  const int most = std::min(kBatch, pattern_.firings() - next_);
  for (int count = 0; count < most; ++count) {
    const Firing firing = pattern_.at(scan_.number, next_ + count);
    const std::int64_t time_ns = scan_.start_ns + firing.offset_ns;
    if (time_ns > track.last_ns()) return count;
    if (auto status = place(track, time_ns); !status) return status.error();
    const std::size_t i = std::size_t(count);
    firings_[i] = firing;
    const double range_m = parameters_.returns.range_max_m / along(firing);
    rays_map_[i] = {origin_map_, map_from_sensor_ * firing.direction_sensor, range_m, time_ns};
    if (!body_.visible()) continue;
    rays_base_[i] = {mount_.position_map, mount_.q_map_base * firing.direction_sensor, range_m};
  }
  return most;
}

// Moves the sensor to where it is at that time.
Status Sensor::place(const PoseTrack& track, std::int64_t time_ns) {
  if (placed_ns_ == time_ns) return success();
  const auto pose = track.at(time_ns);
  if (!pose) {
    return fail(ErrorCode::tracking_lost,
                "the vehicle's poses have a gap: the scan is given up; publish odometry at 10 Hz "
                "or more");
  }
  const Eigen::Matrix3d turn = pose->q_map_base.toRotationMatrix();
  origin_map_ = pose->position_map + turn * mount_.position_map;
  map_from_sensor_ = turn * mount_.q_map_base.toRotationMatrix();
  placed_ns_ = time_ns;
  return success();
}

Status Sensor::look(const World& world, std::size_t count) {
  if (world.contains(rays_map_[0].origin)) {
    return fail(ErrorCode::collision,
                fmt::format("the sensor sits inside of an obstacle at {} m: the scan is given up",
                            to_text(rays_map_[0].origin)));
  }
  world.cast({rays_map_.data(), count}, {hits_.data(), count});
  if (!body_.visible()) return success();
  body_.cast({rays_base_.data(), count}, {own_hits_.data(), count}, random_);
  for (std::size_t i = 0; i < count; ++i) {
    if (own_hits_[i].range_m < hits_[i].range_m) hits_[i] = own_hits_[i];
  }
  return success();
}

void Sensor::record(std::size_t i) {
  const Firing& firing = firings_[i];
  const std::size_t n = std::size_t(next_) + i;
  const std::size_t before = std::size_t(pattern_.neighbour());
  const double share = along(firing);
  true_m_[n] = hits_[i].range_m * share;
  const double beside_m = n >= before ? true_m_[n - before] : true_m_[n];
  Return& r = scan_.returns[n];
  r = {.offset_ns = std::uint32_t(firing.offset_ns), .ring = firing.ring};
  const auto measured_m = model_.measure(true_m_[n], beside_m, random_);
  if (!measured_m) return;
  r.valid = true;
  r.intensity = float(parameters_.returns.reflectivity * hits_[i].cosine);
  const Vec3 point = *measured_m / share * model_.direction(firing.direction_sensor, random_);
  r.point = point.cast<float>();
}

// How much of a ray's length the sensor measures: all of it, or its part along a camera's axis.
double Sensor::along(const Firing& firing) const {
  const bool camera = parameters_.pattern.pattern == Pattern::depth_camera;
  return camera ? firing.direction_sensor.x() : 1.0;
}

}  // namespace goshawk::sensors
