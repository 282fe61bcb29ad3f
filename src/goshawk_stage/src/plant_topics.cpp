#include "goshawk/stage/plant_topics.hpp"

#include "goshawk/conversions/vehicle.hpp"

namespace goshawk::stage {

using nav_msgs::msg::Odometry;
using runtime::Qos;

PlantTopics::PlantTopics(runtime::Node& node, StageReporter& reporter, bool with_truth)
    : reporter_(reporter),
      odometry_(node.advertise<Odometry>("odom", Qos::state())),
      status_(
          node.advertise<goshawk_msgs::msg::VehicleStatus>("vehicle_status", Qos::state())),
      tf_(node.advertise<tf2_msgs::msg::TFMessage>("/tf", Qos::reliable_last(10))) {
  if (with_truth) truth_ = node.advertise<Odometry>("odom_true", Qos::state());
}

void PlantTopics::publish_odometry(const RigidBodyState& state, std::int64_t stamp_ns) {
  message_.header().stamp(conversions::to_stamp(stamp_ns));
  conversions::fill_msg(state, message_);
  reporter_.send(odometry_, message_);
}

void PlantTopics::publish_truth(const RigidBodyState& state, std::int64_t stamp_ns) {
  if (!truth_) return;
  message_.header().stamp(conversions::to_stamp(stamp_ns));
  conversions::fill_msg(state, message_);
  reporter_.send(*truth_, message_);
}

void PlantTopics::publish_status(goshawk_msgs::msg::VehicleStatus status, std::int64_t stamp_ns) {
  status.header(conversions::make_header(stamp_ns));
  reporter_.send(status_, status);
}

void PlantTopics::publish_pose(const RigidBodyState& state, std::int64_t stamp_ns) {
  geometry_msgs::msg::TransformStamped transform;
  transform.header(conversions::make_header(stamp_ns));
  transform.child_frame_id(std::string(conversions::kBodyFrame));
  transform.transform().translation(conversions::to_vector(state.position_map));
  transform.transform().rotation(conversions::to_msg(state.q_map_base));
  tf2_msgs::msg::TFMessage tf;
  tf.transforms().push_back(transform);
  reporter_.send(tf_, tf);
}

}  // namespace goshawk::stage
