#pragma once

#include <string>

#include "config.hpp"
#include "goshawk/sensors/sensor.hpp"
#include "sensor_msgs.h"
#include "tf2_msgs.h"

namespace goshawk::sensors {

/// How a scan becomes a cloud.
struct CloudForm {
  Fields fields = Fields::velodyne;      // not automatic
  Missing missing = Missing::leave_out;  // not automatic
  int channels = 1;                      // ouster: rows of the organised cloud
  bool optical = false;                  // x right, y down, z forward
  CloudFrame frame = CloudFrame::sensor;
  Pose mount;
  std::string frame_id;

  /// What the parameters say, automatic replaced.
  static CloudForm of(const Config& config);
};

/// @return invalid_parameter for missing returns as zeros in a frame whose origin is not the sensor:
/// there a zero is an obstacle
Status check_missing(const Config& config);

/// Names of the frames that a sensor has.
std::string optical_frame(const Config& config);

/// Overwrites the message; its memory is used again.
/// @param track the poses of the scan, for a cloud in `map`: a return without a pose counts as
/// missing
void fill_msg(const Scan& scan, const CloudForm& form, const PoseTrack& track,
              sensor_msgs::msg::PointCloud2& m);

/// Depths of a depth camera. @pre the scan has one return a pixel
void fill_msg(const Scan& scan, const Config& config, sensor_msgs::msg::Image& m);

/// Without distortion. The header is the image's.
sensor_msgs::msg::CameraInfo camera_info(const PatternParameters& pattern);

/// base_link to the sensor, and for a camera on to its optical frame.
tf2_msgs::msg::TFMessage static_transforms(const Config& config, std::int64_t stamp_ns);

}  // namespace goshawk::sensors
