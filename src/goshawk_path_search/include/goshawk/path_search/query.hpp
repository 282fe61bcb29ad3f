#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <stop_token>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::path_search {

/// When to give up: at a point in time, or when somebody asks. A search looks every thousand
/// expansions or so.
struct StopSignal {
  using Clock = std::chrono::steady_clock;

  std::optional<Clock::time_point> deadline;
  std::stop_token token;

  /// @return deadline_exceeded or cancelled
  Status check() const;

  static StopSignal after(double seconds);
};

/// An end of a path: the voxel, and the point in it.
struct End {
  Index3 cell;
  Vec3 at_grid = Vec3::Zero();  // [voxel units, GridGeometry::to_grid]

  static End center_of(Index3 cell) {
    return {cell, Vec3(cell.x + 0.5, cell.y + 0.5, cell.z + 0.5)};
  }
};

/// What to search for: the best path from the start to any one of the goals.
struct GridQuery {
  End start;
  std::span<const End> goals;
  StopSignal stop;
};

}  // namespace goshawk::path_search
