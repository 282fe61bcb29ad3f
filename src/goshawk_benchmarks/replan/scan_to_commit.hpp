#pragma once

#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/recording/reader.hpp"

namespace goshawk::bench {

/// What of a live flight's time it takes from a scan to what is flown because of it.
struct ScanToCommit {
  std::vector<double> latency_ms = {};  // sorted; one a scan that was answered by a commit
  int scans = 0;                        // that made the map new
  int commits = 0;
};

/// From a recording with `points`, `map/voxels/updates` and `committed_trajectory`: from the moment
/// when the sensor publishes a scan to the moment when the navigator publishes the first commit
/// that was proved in a map with that scan, if it comes before the next scan. By the senders'
/// clocks, which are one on one machine.
Result<ScanToCommit> scan_to_commit(recording::Reader& reader);

/// Flies `goshawk fly --live` with a launch file, and measures it.
/// @throws std::runtime_error if the flight did not arrive, with the flight's own words
ScanToCommit fly_live(const std::string& launch);

}  // namespace goshawk::bench
