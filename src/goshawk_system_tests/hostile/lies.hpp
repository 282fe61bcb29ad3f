#pragma once

#include "goshawk/core/vehicle.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"
#include "sensor_msgs.h"

/// Messages that are well formed, and false.
namespace goshawk::hostile {

/// Straight from rest at `from` to rest at `to`, through whatever is between, within the limits of
/// the request and certified against a polytope of its own.
goshawk_msgs::msg::BezierTrajectory straight(const goshawk_msgs::msg::PlanRequest& request,
                                             const Vec3& from, const Vec3& to);

/// A request as a navigator would make it.
goshawk_msgs::msg::PlanRequest request_for(std::uint64_t id, const Vec3& from, const Vec3& to,
                                           std::int64_t now_ns);

goshawk_msgs::msg::CommittedTrajectory commit(const goshawk_msgs::msg::BezierTrajectory& nominal,
                                              std::uint64_t map_version, std::int64_t start_ns);

/// One box around start and goal.
goshawk_msgs::msg::Corridor wide_corridor(const goshawk_msgs::msg::PlanRequest& request);

/// The grid with every voxel free and known, or every voxel blocked.
goshawk_msgs::msg::VoxelGrid all_free(goshawk_msgs::msg::VoxelGrid grid);
goshawk_msgs::msg::VoxelGrid all_blocked(goshawk_msgs::msg::VoxelGrid grid);

/// An update of this grid that frees all of its bricks.
goshawk_msgs::msg::VoxelGridUpdate freeing_update(const goshawk_msgs::msg::VoxelGrid& grid);

/// The vehicle somewhere else, seen `ahead_ns` later.
nav_msgs::msg::Odometry moved(nav_msgs::msg::Odometry odometry, const Vec3& by,
                              std::int64_t ahead_ns);

/// Full thrust, tilted.
goshawk_msgs::msg::AttitudeSetpoint full_tilt(std::int64_t now_ns);

/// A fallback stop from rest at `from` to rest at `to`, in a second, through whatever is between.
goshawk_msgs::msg::FallbackStop stop_elsewhere(const Vec3& from, const Vec3& to,
                                               std::int64_t now_ns);

/// Clouds in frame `map`, as a lidar at `eye` would send them.
/// A wall 1 m before the eye, towards `to`.
sensor_msgs::msg::PointCloud2 cloud_of_wall(const Vec3& eye, const Vec3& to, std::int64_t stamp_ns);
/// Returns from 7.5 m all around: every ray says that what it crosses is free.
sensor_msgs::msg::PointCloud2 cloud_of_nothing(const Vec3& eye, std::int64_t stamp_ns);
/// Points that are no numbers, or are farther away than any world.
sensor_msgs::msg::PointCloud2 cloud_of_garbage(const Vec3& eye, std::int64_t stamp_ns);

}  // namespace goshawk::hostile
