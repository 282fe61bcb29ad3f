#pragma once

#include <memory>
#include <vector>

#include "goshawk/movers/mover.hpp"
#include "goshawk/obstacle_tracker_lab/score.hpp"
#include "goshawk/sensors/sensor.hpp"

namespace goshawk::obstacle_tracker {

/// A simulated vehicle with a lidar in a world where things move, and a tracker that is judged.
struct LabCase {
  std::vector<movers::Mover> movers{};
  sensors::SensorParameters sensor{};
  Vec3 start_map = Vec3(0.0, 0.0, 1.5);  // [m] of the vehicle
  Vec3 velocity_map = Vec3::Zero();      // [m/s] of the vehicle
  double duration_s = 20.0;
  Config tracker{};
  /// The still world: a hall of 60 x 40 x 8 m about (10, 0) with pillars.
  int pillars = 12;
};

struct LabResult {
  Figures figures;
  double scan_mean_us = 0.0, scan_most_us = 0.0;  // processor time of ObstacleTracker::add()
  int scans = 0;
};

/// @return the failure of the sensor, the world or the tracker, if there is one; the same case
/// gives the same figures
Result<LabResult> run_lab(const LabCase& lab_case);

/// os0_128 with half of its columns: 65,536 rays a scan at 10 Hz.
sensors::SensorParameters lab_lidar();

/// A person who stands for 3 s, walks 8 m across the view, waits for 1 s, and walks back.
movers::Mover crossing_person(std::uint64_t id, double distance_m, double speed_m_s);

}  // namespace goshawk::obstacle_tracker
