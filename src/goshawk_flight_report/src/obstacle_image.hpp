#pragma once

#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "plot.hpp"

namespace goshawk::flight_report {

/// Which axes of the map lie along the picture: 0, 1, 2 for x, y, z; w is looked along.
struct View {
  int u = 0;
  int v = 1;
  int w = 2;
};

inline constexpr Color kBlocked{0.28, 0.32, 0.38};
inline constexpr Color kElsewhere{0.80, 0.82, 0.85};
inline constexpr Color kGrown{0.985, 0.895, 0.79};
inline constexpr Color kUnknown{0.94, 0.93, 0.90};

/// The voxels of a window as one pixel each. A cell is looked at where the flight passes nearby:
/// the point of `guide` nearest to it in the picture says at which depth. Blocked there within
/// half_depth_m: dark. Blocked for the vehicle's centre only (grown): tinted. Blocked at other
/// depths: light, the darker the more of the column is. Not measured there: a shade of its own.
struct ObstacleImage {
  Image image;
  Interval u;  // what it covers; may reach beyond the window by part of a voxel
  Interval v;
};

/// @param obstacles, grown either may be nullptr; @param guide may be empty: then the whole
/// column counts as near
ObstacleImage obstacle_image(const VoxelGrid* obstacles, const VoxelGrid* grown, const View& view,
                             const Interval& u, const Interval& v, const std::vector<Vec3>& guide,
                             double half_depth_m);

}  // namespace goshawk::flight_report
