#pragma once

#include <cstdint>

#include "goshawk/core/result.hpp"

namespace goshawk::map_server {

/// What a scan adds to a voxel's confidence: one step a voxel and scan, whatever the number of
/// rays. Unknown voxels begin at 0.
struct OddsModel {
  int hit = 27;       // added if a ray ends in the voxel ...
  int miss = 13;      // ... else taken off if one passes through it
  int least = -53;    // confidence stays from here ...
  int most = 52;      // ... to here; both within int8
  int occupied = 1;   // an obstacle from here on

  /// @param hits_needed scans [1, 4] that must hit a voxel seen free for long before it blocks;
  /// a voxel that was unknown blocks at the first hit
  /// @param misses_needed scans [1, 9] that must see through an obstacle hit for long before it is
  /// free again
  /// @return invalid_parameter outside these ranges
  static Result<OddsModel> make(int hits_needed, int misses_needed);

  /// OctoMap's defaults in steps of 1/32 of its log-odds: hit 0.7, miss 0.4, clamped to 0.1192 and
  /// 0.971.
  static OddsModel octomap() { return {27, 13, -64, 112, 0}; }
};

}  // namespace goshawk::map_server
