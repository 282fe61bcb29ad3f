#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/pose_buffer.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

/// The map server's parameters; the defaults are valid.
struct Config {
  std::string map_file = "";
  UnknownPolicy unknown = UnknownPolicy::occupied;
  double radius_m = 0.15;
  double margin_m = 0.05;
  double reserve_m = 0.0;
  double resolution_m = 0.2;
  CloudMeaning cloud_meaning = CloudMeaning::map;
  CloudFrame cloud_frame = CloudFrame::automatic;
  double cloud_scale = 1.0;
  double cloud_origin_x_m = 0.0;
  double cloud_origin_y_m = 0.0;
  double cloud_origin_z_m = 0.0;
  double max_range_m = 30.0;
  bool use_box = false;
  double box_x_min_m = 0.0;
  double box_y_min_m = 0.0;
  double box_z_min_m = 0.0;
  double box_x_max_m = 10.0;
  double box_y_max_m = 10.0;
  double box_z_max_m = 4.0;
  int max_voxels = 1'000'000'000;
  bool follow_vehicle = false;
  int max_kept_mb = 1000;
  int hits_needed = 2;
  int misses_needed = 4;
  double body_radius_m = 0.2;
  std::string sensor_frame = "";
  double sensor_x_m = 0.0;
  double sensor_y_m = 0.0;
  double sensor_z_m = 0.0;
  double sensor_roll_rad = 0.0;
  double sensor_pitch_rad = 0.0;
  double sensor_yaw_rad = 0.0;
  double pose_wait_s = 0.2;
  double pose_max_gap_s = 0.5;
  int max_points = 1'000'000;
  bool any_sensor = false;
  double sensor_timeout_s = 2.0;
  bool publish_raw = false;
  std::string journal_file = "";
};

namespace detail {

template <typename Self, typename Visitor>
void describe_file(Self& c, Visitor& visit) {
  visit("map_file", c.map_file, "",
        "map to load (.bt, .ot, .pcd, .ply, .stl, .obj, .3dmap); empty: the box begins as unknown "
        "space",
        Anything{});
  visit("unknown", c.unknown, "",
        "space that was not measured: occupied (an obstacle that grows), blocked (an obstacle "
        "that does not grow) or free",
        Anything{});
  visit("radius_m", c.radius_m, "m", "radius of the ball around the vehicle", Range{0.0, 100.0});
  visit("margin_m", c.margin_m, "m", "added to the radius: covers the tracking error",
        Range{0.0, 100.0});
  visit("reserve_m", c.reserve_m, "m",
        "plans keep this much more; with unknown: free, what is flown need not, so that a voxel "
        "that becomes an obstacle late does not stop the vehicle. About a voxel for a map that a "
        "sensor makes; sends raw voxels as publish_raw does",
        Range{0.0, 100.0});
  visit("resolution_m", c.resolution_m, "m",
        "voxel edge for clouds, .3dmap files and live scans; OctoMap files bring their own",
        Range::positive(100.0));
  visit("cloud_meaning", c.cloud_meaning, "",
        "what a cloud file says of the space between its points: map (free), points (nothing) or "
        "scan (the rays from the sensor are free)",
        Anything{});
  visit("cloud_frame", c.cloud_frame, "",
        "what the points of a cloud file with a VIEWPOINT refer to: sensor (its pose is applied), "
        "map (it only says where the sensor was), or automatic (sensor if it is turned; map for a "
        "scan; else the file is refused)",
        Anything{});
  visit("cloud_scale", c.cloud_scale, "m",
        "a unit of a cloud file's coordinates: 0.001 for millimetres", Range::positive(1e6));
  visit("cloud_origin_x_m", c.cloud_origin_x_m, "m",
        "where the map frame's origin lies in a cloud file (scaled): subtracted from every point",
        Anything{});
  visit("cloud_origin_y_m", c.cloud_origin_y_m, "m", "the same for y", Anything{});
  visit("cloud_origin_z_m", c.cloud_origin_z_m, "m", "the same for z", Anything{});
}

template <typename Self, typename Visitor>
void describe_window(Self& c, Visitor& visit) {
  visit("use_box", c.use_box, "", "cut the map to the box; needed if map_file is empty",
        Anything{});
  visit("box_x_min_m", c.box_x_min_m, "m", "lower corner of the box", Anything{});
  visit("box_y_min_m", c.box_y_min_m, "m", "lower corner of the box", Anything{});
  visit("box_z_min_m", c.box_z_min_m, "m", "lower corner of the box", Anything{});
  visit("box_x_max_m", c.box_x_max_m, "m", "upper corner of the box", Anything{});
  visit("box_y_max_m", c.box_y_max_m, "m", "upper corner of the box", Anything{});
  visit("box_z_max_m", c.box_z_max_m, "m", "upper corner of the box", Anything{});
  visit("max_voxels", c.max_voxels, "", "larger maps are refused", Range{1.0, 2147483647.0});
  visit("follow_vehicle", c.follow_vehicle, "",
        "the box moves with the vehicle in steps of 64 x 8 x 8 voxels; what leaves it is kept and "
        "comes back with it",
        Anything{});
  visit(
      "max_kept_mb", c.max_kept_mb, "MB",
      "memory for what left the box; beyond it, what left first is forgotten, and becomes unknown "
      "space; a report says so",
      Range{1.0, 1e6});
}

template <typename Self, typename Visitor>
void describe_beliefs(Self& c, Visitor& visit) {
  visit("hits_needed", c.hits_needed, "",
        "scans that must hit a voxel seen free for long before it is an obstacle; a voxel that was "
        "unknown is one at the first hit",
        Range{1.0, 4.0});
  visit("misses_needed", c.misses_needed, "",
        "scans that must see through an obstacle before it is free: 4 at 10 Hz take 0.4 s",
        Range{1.0, 9.0});
  visit("body_radius_m", c.body_radius_m, "m",
        "points of a scan nearer than this to the vehicle's centre are the vehicle itself, and the "
        "space it flew through is free; 0: neither",
        Range{0.0, 5.0});
}

template <typename Self, typename Visitor>
void describe_sensor(Self& c, Visitor& visit) {
  visit("sensor_frame", c.sensor_frame, "",
        "a sensor's frame that is not on /tf_static: the parameters below place it in base_link",
        Anything{});
  visit("sensor_x_m", c.sensor_x_m, "m", "place of sensor_frame in base_link", Anything{});
  visit("sensor_y_m", c.sensor_y_m, "m", "place of sensor_frame in base_link", Anything{});
  visit("sensor_z_m", c.sensor_z_m, "m", "place of sensor_frame in base_link", Anything{});
  visit("sensor_roll_rad", c.sensor_roll_rad, "rad",
        "attitude of sensor_frame in base_link: about x, then y, then z, all of base_link",
        Anything{});
  visit("sensor_pitch_rad", c.sensor_pitch_rad, "rad", "the same about y", Anything{});
  visit("sensor_yaw_rad", c.sensor_yaw_rad, "rad", "the same about z", Anything{});
}

template <typename Self, typename Visitor>
void describe_poses(Self& c, Visitor& visit) {
  visit("pose_wait_s", c.pose_wait_s, "s",
        "how long a cloud waits for odometry as new as its last point; then it is dropped",
        Range{0.0, 10.0});
  visit("pose_max_gap_s", c.pose_max_gap_s, "s",
        "no pose is interpolated between odometry farther apart than this", Range{0.0, 10.0});
  visit("max_points", c.max_points, "", "clouds with more points are refused",
        Range{1.0, 100'000'000.0});
  visit(
      "any_sensor", c.any_sensor, "",
      "take clouds, depth images and camera infos from every process; false: of each from one, the "
      "first that is found",
      Anything{});
  visit("sensor_timeout_s", c.sensor_timeout_s, "s",
        "a sensor of which no scan comes, or none that sees anything, for so long is reported; 0: "
        "never",
        Range{0.0, 3600.0});
}

}  // namespace detail

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  detail::describe_file(c, visit);
  visit("max_range_m", c.max_range_m, "m", "longest ray of a scan that may hit something",
        AtRunTime{Range::positive(1000.0)});
  detail::describe_window(c, visit);
  detail::describe_beliefs(c, visit);
  detail::describe_sensor(c, visit);
  detail::describe_poses(c, visit);
  visit("publish_raw", c.publish_raw, "",
        "map/voxels also brings the obstacles as measured: a corridor_builder with margin sphere "
        "needs them",
        Anything{});
  visit(
      "journal_file", c.journal_file, "",
      "keeps what scans have told, so that a map server that was killed goes on with the map that "
      "it had; a launch names one in its folder of logs; empty: none",
      Anything{});
}

/// The config in the terms of the functions that do the work. @pre values as describe() allows
LoadOptions load_options(const Config& config);
VoxelizeOptions voxelize_options(const Config& config);
Growth growth(const Config& config);
Result<LiveOptions> live_options(const Config& config);
/// That bricks which left the window had to be forgotten: map_too_large.
Error forgotten_fault(const Config& config);
/// sensor_frame in base_link
Pose sensor_mount(const Config& config);

}  // namespace goshawk::map_server
