#include "goshawk/introspection/codec.hpp"

#include <gmock/gmock.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <nlohmann/json.hpp>

#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"
#include "octomap_msgs.h"
#include "random_message.hpp"
#include "sensor_msgs.h"
#include "tf2_msgs.h"
#include "trajectory_msgs.h"
#include "visualization_msgs.h"

// Counts what is claimed from the heap, to prove that hostile lengths claim none.
namespace {
std::atomic<std::size_t> g_now = 0;
std::atomic<std::size_t> g_peak = 0;
}  // namespace

void* operator new(std::size_t size) {
  void* memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t now = g_now += malloc_usable_size(memory);
  if (now > g_peak) g_peak = now;
  return memory;
}
void operator delete(void* memory) noexcept {
  if (memory != nullptr) g_now -= malloc_usable_size(memory);
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<unsigned char>;
using testing::HasSubstr;

template <typename Message>
class EveryMessage : public testing::Test {
 public:
  static const Type& type() {
    return **find_type(runtime::ros_type_name(runtime::message_type<Message>().name()));
  }
};

using Messages = testing::Types<
    std_msgs::msg::String, geometry_msgs::msg::PoseStamped, nav_msgs::msg::Path,
    nav_msgs::msg::Odometry, sensor_msgs::msg::PointCloud2, sensor_msgs::msg::Image,
    sensor_msgs::msg::CameraInfo, visualization_msgs::msg::MarkerArray, octomap_msgs::msg::Octomap,
    tf2_msgs::msg::TFMessage, goshawk_msgs::msg::VoxelGrid, goshawk_msgs::msg::VoxelGridUpdate,
    goshawk_msgs::msg::PlanRequest, goshawk_msgs::msg::Path, goshawk_msgs::msg::Corridor,
    goshawk_msgs::msg::BezierTrajectory, goshawk_msgs::msg::CommittedTrajectory,
    goshawk_msgs::msg::AttitudeSetpoint, goshawk_msgs::msg::FallbackStop,
    goshawk_msgs::msg::StageReport, goshawk_msgs::msg::NavigatorState,
    goshawk_msgs::msg::TrackingState, goshawk_msgs::msg::ParameterAnswer,
    goshawk_msgs::msg::VehicleStatus, goshawk_msgs::msg::Goal, goshawk_msgs::msg::Mission,
    goshawk_msgs::msg::MissionState, goshawk_msgs::msg::OperatorCommand,
    goshawk_msgs::msg::OperatorAnswer, trajectory_msgs::msg::MultiDOFJointTrajectory,
    goshawk_msgs::msg::PolynomialPlan, goshawk_msgs::msg::BsplinePlan,
    goshawk_msgs::msg::GuardVerdict>;
TYPED_TEST_SUITE(EveryMessage, Messages);

TYPED_TEST(EveryMessage, IsByteForByteWhatTheGeneratedCodeWrites) {
  RandomMessage random(1);
  for (int i = 0; i < 50; ++i) {
    const Json json = random.of(this->type());
    const auto bytes = json_to_cdr(this->type(), json);
    ASSERT_TRUE(bytes) << bytes.error().message;
    TypeParam message;
    ASSERT_TRUE(runtime::decode(*bytes, message)) << json.dump();
    EXPECT_EQ(runtime::encode(message), *bytes) << json.dump();
    const auto back = cdr_to_json(this->type(), *bytes);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->dump(), json.dump());
  }
}

TYPED_TEST(EveryMessage, IsZeroWhereTheJsonLeavesItOut) {
  const auto bytes = json_to_cdr(this->type(), Json::object());
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(*bytes, runtime::encode(TypeParam{}));
}

TYPED_TEST(EveryMessage, IsAnErrorWhenCutOffAnywhere) {
  const auto bytes = json_to_cdr(this->type(), RandomMessage(2).of(this->type()));
  ASSERT_TRUE(bytes);
  for (std::size_t length = 0; length < bytes->size(); ++length) {
    const auto json = cdr_to_json(this->type(), std::span(*bytes).first(length));
    EXPECT_FALSE(json) << length << " of " << bytes->size() << " bytes";
    EXPECT_FALSE(json.ok() || json.error().message.empty());
  }
}

// JSON costs about 16 bytes a number and 60 a field, so the bound is linear with that factor.
TYPED_TEST(EveryMessage, SurvivesFlippedBitsWithoutClaimingMemory) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    auto bytes = *json_to_cdr(this->type(), RandomMessage(random.next()).of(this->type()));
    for (int flips = 1 + random.below(4); flips > 0; --flips) {
      bytes[std::size_t(random.below(int(bytes.size())))] ^= (unsigned char)(1 + random.below(255));
    }
    const std::size_t before = g_now;
    g_peak = before;
    {
      const auto json = cdr_to_json(this->type(), bytes);
      EXPECT_NE(json.ok(), json.code() != ErrorCode::ok);
    }
    EXPECT_LT(g_peak - before, 100 * bytes.size() + 10'000);
    TypeParam message;
    (void)runtime::decode(bytes, message);  // must come back, with whatever answer
  }
}

const Type& type(const char* name) {
  return **find_type(name);
}

TEST(JsonToCdr, TakesTheNameOfAConstant) {
  const Type& state = type("goshawk_msgs/msg/NavigatorState");
  const auto named = json_to_cdr(state, Json{{"state", "STATE_ARRIVED"}});
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(*named, *json_to_cdr(state, Json{{"state", 3}}));
  EXPECT_EQ((*cdr_to_json(state, *named))["state"], 3);
  const auto unknown = json_to_cdr(state, Json{{"state", "ARRIVED"}});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("STATE_IDLE, STATE_PLANNING"));
  EXPECT_FALSE(json_to_cdr(type("goshawk_msgs/msg/BezierPiece"), Json{{"polytope", "NAME"}}));
}

TEST(CdrToJson, ReadsBothByteOrders) {
  const Bytes little = {0, 1, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0};
  const Bytes big = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2};
  for (const auto& bytes : {little, big}) {
    const auto json = cdr_to_json(type("builtin_interfaces/msg/Time"), bytes);
    ASSERT_TRUE(json) << json.error().message;
    EXPECT_EQ(json->dump(), R"({"sec":1,"nanosec":2})");
  }
}

TEST(CdrToJson, AlignsFromBehindTheEncapsulation) {
  // "a" and its zero end at offset 6, two bytes of padding, the double 1.0 at offset 8.
  const Bytes bytes = {0, 1, 0, 0, 2, 0, 0, 0, 'a', 0, 0xee, 0xee, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f};
  const auto json = cdr_to_json(type("goshawk_msgs/msg/Counter"), bytes);
  ASSERT_TRUE(json) << json.error().message;
  EXPECT_EQ(json->dump(), R"({"name":"a","value":1.0})");
}

TEST(CdrToJson, RefusesLengthsThatCannotBe) {
  // std_msgs/String of 10^9 characters; PointCloud2-like sequence of 10^9 poses.
  const Bytes text = {0, 1, 0, 0, 0x00, 0xca, 0x9a, 0x3b, 'a', 0};
  const auto json = cdr_to_json(type("std_msgs/msg/String"), text);
  ASSERT_FALSE(json);
  EXPECT_THAT(json.error().message, HasSubstr("data claims 1000000000 characters"));

  Bytes path = *json_to_cdr(type("nav_msgs/msg/Path"), Json::object());
  path[path.size() - 1] = 0x3b;  // the top byte of the sequence's length
  const auto poses = cdr_to_json(type("nav_msgs/msg/Path"), path);
  ASSERT_FALSE(poses);
  EXPECT_THAT(poses.error().message, HasSubstr("poses claims"));
}

TEST(CdrToJson, RefusesAStringThatEndsBeforeItsEnd) {
  const Bytes text = {0, 1, 0, 0, 4, 0, 0, 0, 'a', 0, 'b', 0};
  const auto json = cdr_to_json(type("std_msgs/msg/String"), text);
  ASSERT_FALSE(json);
  EXPECT_THAT(json.error().message, HasSubstr("data contains a zero character"));
}

TEST(CdrToJson, NamesTheFieldAtFault) {
  auto bytes = *json_to_cdr(type("goshawk_msgs/msg/VehicleStatus"), Json::object());
  bytes[4 + 8 + 4 + 1] = 7;  // stamp, frame_id's length, its zero, then the bool
  const auto json = cdr_to_json(type("goshawk_msgs/msg/VehicleStatus"), bytes);
  ASSERT_FALSE(json);
  EXPECT_THAT(json.error().message, HasSubstr("armed is a bool of value 7"));
}

TEST(CdrToJson, RefusesOtherEncapsulationsAndLeftovers) {
  Bytes bytes = *json_to_cdr(type("builtin_interfaces/msg/Time"), Json::object());
  for (const unsigned char kind : {2, 3, 6, 7, 255}) {  // parameter lists, XCDR2
    Bytes wrong = bytes;
    wrong[1] = kind;
    EXPECT_FALSE(cdr_to_json(type("builtin_interfaces/msg/Time"), wrong)) << int(kind);
  }
  bytes.resize(bytes.size() + 3);
  EXPECT_TRUE(cdr_to_json(type("builtin_interfaces/msg/Time"), bytes));  // padding
  bytes.resize(bytes.size() + 1);
  EXPECT_FALSE(cdr_to_json(type("builtin_interfaces/msg/Time"), bytes));
}

std::string fault(const char* type_name, const char* json) {
  const auto bytes = json_to_cdr(type(type_name), Json::parse(json));
  return bytes ? "no fault" : bytes.error().message;
}

TEST(JsonToCdr, NamesTheNearestFieldForAnUnknownOne) {
  EXPECT_THAT(
      fault("geometry_msgs/msg/PoseStamped", R"({"header": {"frameid": "map"}})"),
      HasSubstr("header 'frameid' is not a field of std_msgs/msg/Header; did you mean frame_id?"));
  EXPECT_THAT(fault("std_msgs/msg/String", R"({"zzzzzzz": 1})"), HasSubstr("its fields are data"));
}

TEST(JsonToCdr, NamesTheFieldThatIsWrong) {
  const char* path = "goshawk_msgs/msg/Path";
  EXPECT_THAT(fault(path, R"({"raw": [{}, {"x": "far"}]})"), HasSubstr("raw[1].x is \"far\""));
  EXPECT_THAT(fault(path, R"({"raw": {}})"), HasSubstr("raw is {}: it must be a list"));
  EXPECT_THAT(fault(path, R"({"expanded": -1})"), HasSubstr("from 0 to 18446744073709551615"));
  EXPECT_THAT(fault(path, R"({"expanded": 1.5})"), HasSubstr("a whole number"));
  EXPECT_THAT(fault(path, R"({"implementation": 1})"), HasSubstr("quote it"));
  EXPECT_THAT(fault(path, R"({"header": null})"), HasSubstr("header is null"));
  EXPECT_THAT(fault(path, "[]"), HasSubstr("must be an object"));
  EXPECT_THAT(fault(path, R"({"implementation": "a\u0000b"})"), HasSubstr("zero character"));
  EXPECT_THAT(fault("goshawk_msgs/msg/Limits", R"({"norm": 256})"), HasSubstr("from 0 to 255"));
  EXPECT_THAT(fault("octomap_msgs/msg/Octomap", R"({"data": [-129]})"),
              HasSubstr("data[0] is -129: it must be from -128 to 127"));
  EXPECT_THAT(fault("octomap_msgs/msg/Octomap", R"({"binary": 1})"), HasSubstr("true or false"));
  EXPECT_THAT(fault("std_msgs/msg/ColorRGBA", R"({"r": 1e39})"), HasSubstr("a float can hold"));
  EXPECT_THAT(fault("goshawk_msgs/msg/BezierPiece", R"({"control_points": [{}]})"),
              HasSubstr("has 1 elements: it must have 6"));
}

}  // namespace
}  // namespace goshawk::introspection
