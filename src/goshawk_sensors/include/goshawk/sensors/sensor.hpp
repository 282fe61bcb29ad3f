#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "goshawk/sensors/firing_pattern.hpp"
#include "goshawk/sensors/pose_track.hpp"
#include "goshawk/sensors/return_model.hpp"
#include "goshawk/sensors/vehicle_body.hpp"

namespace goshawk::sensors {

/// What came back of one ray.
struct Return {
  /// [m] frame of the sensor (x forward) at the moment of the ray; zero for a missing return
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  float intensity = 0.0F;       // reflectivity times the cosine of the angle of incidence
  std::uint32_t offset_ns = 0;  // from the start of the scan
  std::uint16_t ring = 0;
  bool valid = false;  // false: a missing return
};

/// One turn of a lidar, or one image. The vehicle moves while a lidar turns, and points are not
/// corrected for that: as drivers publish them.
struct Scan {
  std::int64_t number = 0;
  std::int64_t start_ns = 0;    // of the first ray
  std::int64_t end_ns = 0;      // when the next scan begins
  std::vector<Return> returns;  // one a ray, in the order of the pattern
};

/// A lidar or a depth camera on a moving vehicle. The same parameters, world, poses and calls give
/// the same bytes.
class Sensor {
 public:
  using Done = std::function<void(const Scan&)>;

  /// @return invalid_parameter with every fault
  static Result<Sensor> create(const SensorParameters& parameters);

  /// Fires all rays up to the newest pose. The first scan begins at the oldest pose of the first
  /// call. Scans that are to be dropped are not handed out.
  /// @param done called with every scan that is complete; the scan is used again afterwards
  /// @return tracking_lost if poses are missing, collision if the sensor sits inside of an
  /// obstacle: the scan is given up and the next one begins at the newest pose
  Status advance(const World& world, const PoseTrack& track, const Done& done);

  const SensorParameters& parameters() const { return parameters_; }
  const FiringPattern& pattern() const { return pattern_; }
  /// The sensor's frame (x forward) in base_link.
  const Pose& mount() const { return mount_; }

 private:
  explicit Sensor(const SensorParameters& parameters);

  void begin(std::int64_t start_ns);
  Status fire(const World& world, const PoseTrack& track);
  Result<int> gather(const PoseTrack& track);
  Status place(const PoseTrack& track, std::int64_t time_ns);
  Status look(const World& world, std::size_t count);
  void record(std::size_t i);
  double along(const Firing& firing) const;

  SensorParameters parameters_;
  FiringPattern pattern_;
  ReturnModel model_;
  VehicleBody body_;
  Pose mount_;  // base_link to sensor: position and rotation of the sensor in base_link

  bool begun_ = false;
  int next_ = 0;  // firing
  Random random_{0};
  Scan scan_;
  std::vector<double> true_m_;  // of the scan's rays
  // Of one batch of rays:
  std::vector<Firing> firings_;
  std::vector<Ray> rays_map_, rays_base_;
  std::vector<Hit> hits_, own_hits_;
  // The pose that is in use:
  std::optional<std::int64_t> placed_ns_;
  Vec3 origin_map_ = Vec3::Zero();
  Eigen::Matrix<double, 3, 3, Eigen::DontAlign> map_from_sensor_;
};

/// Rotation of a sensor in base_link: roll about x, then pitch about y, then yaw about z, all of
/// base_link.
Pose mount_of(const MountParameters& mount);

}  // namespace goshawk::sensors
