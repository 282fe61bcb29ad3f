#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/sensors/parameters.hpp"
#include "goshawk/sensors/voxel_world.hpp"

namespace goshawk::sensors {

/// The fields of a cloud, as drivers publish them (docs/sensing.md has the bytes).
enum class Fields {
  automatic,  // as the driver of this kind of sensor
  velodyne,   // x y z intensity ring time
  ouster,     // x y z intensity t reflectivity ring ambient range; organised
  livox,      // x y z intensity tag line timestamp
  xyz,
};

constexpr auto words_of(Fields) {
  using enum Fields;
  return std::to_array<Named<Fields>>({{automatic, "automatic"},
                                       {velodyne, "velodyne"},
                                       {ouster, "ouster"},
                                       {livox, "livox"},
                                       {xyz, "xyz"}});
}

/// What stands in a cloud for a missing return.
enum class Missing {
  automatic,  // as the driver of this kind of sensor
  leave_out,  // no point
  zero,       // a point at the sensor; only in the sensor's frame
  nan,        // a point that is not a number
};

constexpr auto words_of(Missing) {
  using enum Missing;
  return std::to_array<Named<Missing>>(
      {{automatic, "automatic"}, {leave_out, "leave_out"}, {zero, "zero"}, {nan, "nan"}});
}

enum class ImageEncoding {
  float_m,    // 32FC1: metres; a missing return is not a number
  integer_mm  // 16UC1: millimetres; a missing return is 0
};

constexpr auto words_of(ImageEncoding) {
  using enum ImageEncoding;
  return std::to_array<Named<ImageEncoding>>({{float_m, "32FC1"}, {integer_mm, "16UC1"}});
}

/// The frame in which the points of a cloud are given.
enum class CloudFrame {
  sensor,     // as drivers publish them
  base_link,  // moved by the mount
  map,        // moved by the vehicle's true pose at each ray, as a perfect registration would
};

constexpr auto words_of(CloudFrame) {
  using enum CloudFrame;
  return std::to_array<Named<CloudFrame>>(
      {{sensor, "sensor"}, {base_link, "base_link"}, {map, "map"}});
}

struct Config {
  SensorParameters sensor;
  std::string world_file = "";
  int world_seed = 1;
  std::string movers_file = "";
  double movers_start_s = 0.0;
  Boundary boundary = Boundary::open;
  std::string frame = "sensor";
  CloudFrame cloud_frame = CloudFrame::sensor;
  Fields fields = Fields::automatic;
  Missing missing = Missing::automatic;
  ImageEncoding image_encoding = ImageEncoding::float_m;
  bool camera_cloud = true;
  bool covered = false;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  describe(c.sensor, visit);
  visit("world_file", c.world_file, "",
        "map of the true world (.bt, .ot, .pcd, .ply, .3dmap); empty: the default made world",
        Anything{});
  visit("world_seed", c.world_seed, "", "seed of the default made world", Range{0.0, 2147483647.0});
  visit("movers_file", c.movers_file, "",
        "what moves in the true world (docs/movers.md); empty: nothing", Anything{});
  visit("movers_start_s", c.movers_start_s, "s",
        "stamp at which the movers' time is 0; the same for all that read the file",
        Range{0.0, 1e10});
  visit(
      "boundary", c.boundary, "",
      "what lies around the world: open (nothing), floor (at its lower face) or box (floor, walls "
      "and ceiling at its faces)",
      Anything{});
  visit("frame", c.frame, "", "name of the sensor's frame", Anything{});
  visit(
      "cloud_frame", c.cloud_frame, "",
      "frame of the points in a cloud: sensor, base_link (moved by the mount), or map (by the true "
      "pose at each ray: without the distortion of motion)",
      Anything{});
  visit("fields", c.fields, "",
        "fields of a cloud: velodyne, ouster, livox, xyz, or automatic (as the driver of this kind "
        "of sensor)",
        Anything{});
  visit("missing", c.missing, "",
        "what stands for a missing return in a cloud: leave_out, zero (only with cloud_frame "
        "sensor), nan, or automatic (as the driver of this kind of sensor; leave_out in other "
        "frames)",
        Anything{});
  visit("image_encoding", c.image_encoding, "",
        "depth camera: 32FC1 (metres) or 16UC1 (millimetres)", Anything{});
  visit("camera_cloud", c.camera_cloud, "", "depth camera: also publish the points as a cloud",
        Anything{});
  visit("covered", c.covered, "", "something covers the lens: no ray returns",
        AtRunTime{Anything{}});
}

}  // namespace goshawk::sensors
