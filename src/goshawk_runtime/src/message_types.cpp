#include "geometry_msgsPubSubTypes.h"
#include "goshawk_msgsPubSubTypes.h"
#include "message_type_impl.hpp"
#include "nav_msgsPubSubTypes.h"
#include "octomap_msgsPubSubTypes.h"
#include "rmw_dds_commonPubSubTypes.h"
#include "rosgraph_msgsPubSubTypes.h"
#include "safe_type.hpp"
#include "sensor_msgsPubSubTypes.h"
#include "std_msgsPubSubTypes.h"
#include "tf2_msgsPubSubTypes.h"
#include "trajectory_msgsPubSubTypes.h"
#include "visualization_msgsPubSubTypes.h"

namespace goshawk::runtime {
namespace {

template <typename Message>
struct PubSubTypeOf;

}  // namespace

template <typename Message>
const MessageType& message_type() {
  static const MessageType type = [] {
    auto impl = std::make_unique<MessageType::Impl>();
    impl->support.reset(new SafeType<typename PubSubTypeOf<Message>::Type>());
    impl->name = impl->support.get_type_name();
    return MessageType(std::move(impl));
  }();
  return type;
}

#define GOSHAWK_MESSAGE(package, name)           \
  namespace {                                    \
  template <>                                    \
  struct PubSubTypeOf<package::msg::name> {      \
    using Type = package::msg::name##PubSubType; \
  };                                             \
  }                                              \
  template const MessageType& message_type<package::msg::name>();

GOSHAWK_MESSAGE(std_msgs, String)
GOSHAWK_MESSAGE(geometry_msgs, PoseStamped)
GOSHAWK_MESSAGE(nav_msgs, Path)
GOSHAWK_MESSAGE(nav_msgs, Odometry)
GOSHAWK_MESSAGE(sensor_msgs, PointCloud2)
GOSHAWK_MESSAGE(sensor_msgs, Image)
GOSHAWK_MESSAGE(sensor_msgs, CameraInfo)
GOSHAWK_MESSAGE(visualization_msgs, MarkerArray)
GOSHAWK_MESSAGE(octomap_msgs, Octomap)
GOSHAWK_MESSAGE(tf2_msgs, TFMessage)
GOSHAWK_MESSAGE(trajectory_msgs, MultiDOFJointTrajectory)
GOSHAWK_MESSAGE(rosgraph_msgs, Clock)
GOSHAWK_MESSAGE(rmw_dds_common, ParticipantEntitiesInfo)
GOSHAWK_MESSAGE(goshawk_msgs, VoxelGrid)
GOSHAWK_MESSAGE(goshawk_msgs, VoxelGridUpdate)
GOSHAWK_MESSAGE(goshawk_msgs, PlanRequest)
GOSHAWK_MESSAGE(goshawk_msgs, Path)
GOSHAWK_MESSAGE(goshawk_msgs, Corridor)
GOSHAWK_MESSAGE(goshawk_msgs, BezierTrajectory)
GOSHAWK_MESSAGE(goshawk_msgs, CommittedTrajectory)
GOSHAWK_MESSAGE(goshawk_msgs, PolynomialPlan)
GOSHAWK_MESSAGE(goshawk_msgs, BsplinePlan)
GOSHAWK_MESSAGE(goshawk_msgs, GuardVerdict)
GOSHAWK_MESSAGE(goshawk_msgs, PredictedObstacles)
GOSHAWK_MESSAGE(goshawk_msgs, MovingBoxes)
GOSHAWK_MESSAGE(goshawk_msgs, AttitudeSetpoint)
GOSHAWK_MESSAGE(goshawk_msgs, FallbackStop)
GOSHAWK_MESSAGE(goshawk_msgs, StageReport)
GOSHAWK_MESSAGE(goshawk_msgs, NavigatorState)
GOSHAWK_MESSAGE(goshawk_msgs, TrackingState)
GOSHAWK_MESSAGE(goshawk_msgs, VehicleStatus)
GOSHAWK_MESSAGE(goshawk_msgs, Turn)
GOSHAWK_MESSAGE(goshawk_msgs, ParameterRequest)
GOSHAWK_MESSAGE(goshawk_msgs, ParameterAnswer)
GOSHAWK_MESSAGE(goshawk_msgs, Goal)
GOSHAWK_MESSAGE(goshawk_msgs, Mission)
GOSHAWK_MESSAGE(goshawk_msgs, MissionState)
GOSHAWK_MESSAGE(goshawk_msgs, OperatorCommand)
GOSHAWK_MESSAGE(goshawk_msgs, OperatorAnswer)

}  // namespace goshawk::runtime
