// Any payload of any type of idl/: what the check admits decodes within the memory that it states,
// or is said not to be such a message. The first byte chooses the type.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "../src/payload_check.hpp"
#include "geometry_msgs.h"
#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "goshawk/runtime/schema.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"
#include "octomap_msgs.h"
#include "rosgraph_msgs.h"
#include "sensor_msgs.h"
#include "std_msgs.h"
#include "tf2_msgs.h"
#include "trajectory_msgs.h"
#include "visualization_msgs.h"

namespace {

using namespace goshawk::runtime;
using Bytes = std::vector<unsigned char>;

// What decodes is encoded again, and the same then.
template <typename Message>
void decode_as(const Bytes& payload) {
  static const PayloadCheck check(message_type<Message>().name());
  const bool admitted = check.fault_of(payload).empty();
  Message message;
  if (!decode(payload, message)) return;
  if (!admitted) std::abort();
  const Bytes again = encode(message);
  Message same;
  if (!decode(again, same) || encode(same) != again) std::abort();
}

template <typename... Messages>
void decode_one(std::size_t which, const Bytes& payload) {
  static constexpr void (*kDecoders[])(const Bytes&) = {decode_as<Messages>...};
  kDecoders[which % sizeof...(Messages)](payload);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace goshawk_msgs::msg;
  if (size == 0) return 0;
  decode_one<VoxelGrid, VoxelGridUpdate, PlanRequest, goshawk_msgs::msg::Path, Corridor,
             BezierTrajectory, CommittedTrajectory, AttitudeSetpoint, FallbackStop, StageReport,
             NavigatorState, TrackingState, VehicleStatus, Turn, ParameterRequest, ParameterAnswer,
             Goal, Mission, MissionState, OperatorCommand, OperatorAnswer, std_msgs::msg::String,
             geometry_msgs::msg::PoseStamped, nav_msgs::msg::Path, nav_msgs::msg::Odometry,
             sensor_msgs::msg::PointCloud2, sensor_msgs::msg::Image, sensor_msgs::msg::CameraInfo,
             visualization_msgs::msg::MarkerArray, octomap_msgs::msg::Octomap,
             tf2_msgs::msg::TFMessage, trajectory_msgs::msg::MultiDOFJointTrajectory,
             PolynomialPlan, BsplinePlan, GuardVerdict, rosgraph_msgs::msg::Clock>(
      data[0], Bytes(data + 1, data + size));
  return 0;
}
