#pragma once

#include <span>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::bench {

/// A scan and where it was made, frame map [m].
struct Shot {
  Vec3 from;
  std::vector<Vec3> points;
};

struct ProcessesOptions {
  double resolution_m = 0.2, range_m = 30.0;
  double inflation_m = 0.2;
  Vec3 lower_map = Vec3::Zero(), upper_map = Vec3::Ones();  // the window
  double rate_hz = 10.0;
  double timeout_s = 2.0;  // then a scan is lost
};

/// From a cloud's publication to a planner's map with it. [ms]
struct ProcessesSamples {
  std::vector<double> total_ms;
  int lost = 0;
};

/// Sends scans to a map server that is a process of its own, and follows its map as planners do, in
/// this process.
/// @return stage_silent if the map server does not start; as MapSubscription
Result<ProcessesSamples> measure_processes(std::span<const Shot> shots,
                                           const ProcessesOptions& options);

}  // namespace goshawk::bench
