#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/recording/sink.hpp"
#include "goshawk/recording/writer.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "octomap_msgs.h"
#include "sensor_msgs.h"
#include "support.hpp"

namespace goshawk::conformance_test {
namespace {

namespace msg = goshawk_msgs::msg;
using runtime::Qos;
using sensor_msgs::msg::PointCloud2;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

enum class MapFault { none, believes_all, not_grown, broken_chain, only_once, silent };

map_server::LiveMap empty_map() {
  return map_server::LiveMap::unknown_space({Vec3(0, 0, 0), Vec3(6, 6, 3)}, 0.2,
                                            {.inflation_m = 0.2})
      .value();
}

/// A map server as somebody else might write it, with one fault.
class ForeignMap {
 public:
  ForeignMap(runtime::Node& node, MapFault fault)
      : node_(node),
        fault_(fault),
        map_(empty_map()),
        reporter_(node, StageRole::map_server, "foreign"),
        wholes_(node.advertise<msg::VoxelGrid>(
            "map/voxels", fault == MapFault::only_once ? Qos::reliable_last() : Qos::latched())),
        updates_(
            node.advertise<msg::VoxelGridUpdate>("map/voxels/updates", Qos::reliable_last(50))),
        octomap_(node.advertise<octomap_msgs::msg::Octomap>("octomap_binary", Qos::latched())) {
    node.subscribe<PointCloud2>("cloud_in", Qos::best_effort(2),
                                [this](const PointCloud2& m, const auto&) { on_cloud(m); });
    node.subscribe<nav_msgs::msg::Odometry>("odom", Qos::best_effort(),
                                            [this](const auto& m, const auto&) {
                                              const auto state = conversions::from_msg(m);
                                              if (state) vehicle_map_ = state->position_map;
                                            });
    node.every(0.3, [this] {
      if (changed_) publish_whole();
    });
    publish_whole();
    octomap_msgs::msg::Octomap m;
    m.header(conversions::make_header(node.now_ns()));
    m.binary(true);
    m.id("OcTree");
    m.resolution(0.2);
    (void)octomap_.publish(m);
    reporter_.ready("here");
  }

 private:
  Status check(const PointCloud2& m) const {
    if (fault_ == MapFault::believes_all) return success();
    if (auto status = conversions::check_frame(m.header(), "map", "a cloud"); !status) {
      return status;
    }
    const bool good = m.fields().size() == 3 && m.fields()[0].name() == "x" &&
                      m.fields()[2].offset() == 8 && !m.is_bigendian() &&
                      m.data().size() == std::size_t(m.row_step());
    return good ? success() : fail(ErrorCode::invalid_input, "this cloud is not understood");
  }

  void on_cloud(const PointCloud2& m) {
    if (auto status = check(m); !status) {
      if (fault_ != MapFault::silent) reporter_.fault(status.error());
      return;
    }
    std::vector<Vec3> points;
    for (std::size_t at = 0; at + 12 <= m.data().size(); at += 12) {
      float p[3];
      std::memcpy(p, m.data().data() + at, sizeof p);
      points.emplace_back(double(p[0]), double(p[1]), double(p[2]));
    }
    const map_server::Scan scan{.points_map = points, .origins_map = {&vehicle_map_, 1}};
    if (auto s = map_.insert_scan(scan, result_); !s) return reporter_.fault(s.error());
    changed_ = true;
    if (fault_ == MapFault::not_grown) return publish_whole();
    msg::VoxelGridUpdate update;
    conversions::fill_msg(result_.update, update);
    update.header(conversions::make_header(node_.now_ns()));
    if (fault_ == MapFault::broken_chain) update.from_version(update.from_version() + 5);
    (void)updates_.publish(update);
  }

  void publish_whole() {
    changed_ = false;
    VoxelGrid grid = map_.grid();
    if (fault_ == MapFault::not_grown) grid.grown = map_.grid().raw;
    msg::VoxelGrid m;
    conversions::fill_msg(grid, m);
    m.header(conversions::make_header(node_.now_ns()));
    (void)wholes_.publish(m);
  }

  runtime::Node& node_;
  MapFault fault_;
  map_server::LiveMap map_;
  map_server::ScanResult result_;
  stage::StageReporter reporter_;
  runtime::Publisher<msg::VoxelGrid> wholes_;
  runtime::Publisher<msg::VoxelGridUpdate> updates_;
  runtime::Publisher<octomap_msgs::msg::Octomap> octomap_;
  Vec3 vehicle_map_ = Vec3::Zero();
  bool changed_ = false;
};

TEST(ConformMapServer, ForeignOnesPassOrFailAtTheRightItems) {
  const auto reports = examine_all<ForeignMap, MapFault>(
      {.stage = "map_server"},
      {MapFault::none, MapFault::believes_all, MapFault::not_grown, MapFault::broken_chain});
  EXPECT_THAT(failed(reports[0]), IsEmpty());
  EXPECT_GE(reports[0].items.size(), 15U);
  EXPECT_GT(reports[0].latency_p50_s, 0.0);

  for (const auto& item : reports[1].items) {
    if (item.name.starts_with("refuses")) {
      EXPECT_FALSE(item.passed) << item.name;
    }
  }
  EXPECT_THAT(failed(reports[1]), Contains("keeps its map after bad clouds"));
  EXPECT_THAT(failed(reports[2]), Contains("obstacles are grown by the map's inflation"));
  EXPECT_THAT(failed(reports[2]), testing::Not(Contains("measured points become obstacles")));
  EXPECT_THAT(failed(reports[3]),
              ElementsAre("updates are consecutive and lead to the next whole map"));
  // Nothing comes however long it is waited for.
  const auto report =
      examine<ForeignMap>({.stage = "map_server", .timeout_s = 0.05}, MapFault::only_once);
  EXPECT_THAT(failed(report), Contains("publishes a map"));
}

PointCloud2 cloud(const Vec3& at, const std::string& first_field) {
  PointCloud2 m;
  m.header(conversions::make_header(1));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    sensor_msgs::msg::PointField field;
    field.name(axis == 0 ? first_field : std::string(1, "xyz"[axis]));
    field.offset(4 * axis);
    field.datatype(7);  // float32
    field.count(1);
    m.fields().push_back(field);
  }
  const float p[] = {float(at.x()), float(at.y()), float(at.z())};
  m.data().resize(sizeof p);
  std::memcpy(m.data().data(), p, sizeof p);
  m.height(1);
  m.width(1);
  m.point_step(sizeof p);
  m.row_step(sizeof p);
  return m;
}

/// Three clouds on /uav1/cloud_in, of which the second lacks x, and another topic's message.
std::string record_clouds(const std::string& file) {
  auto writer = *recording::Writer::create(*recording::create_file(file, true));
  const auto schema = writer.add_schema("sensor_msgs/msg/PointCloud2", "", "");
  const auto clouds = writer.add_channel({0, schema, "/uav1/cloud_in", "cdr", {}});
  const auto other = writer.add_channel({0, 0, "/other", "cdr", {}});
  const unsigned char nothing[] = {0, 1, 0, 0};
  EXPECT_TRUE(writer.write({other, 0, 1, 1, nothing}));
  std::uint32_t number = 0;
  for (const char* field : {"x", "u", "x"}) {
    const auto bytes = runtime::encode(cloud(Vec3(1.0 + number, 2.0, 1.0), field));
    EXPECT_TRUE(writer.write({clouds, number, number + 2, number + 2, bytes}));
    ++number;
  }
  EXPECT_TRUE(writer.close());
  return file;
}

TEST(ConformMapServer, RecordedCloudsMustChangeTheMapOrBeRefused) {
  const std::string file = record_clouds(testing::TempDir() + "conform_clouds.mcap");
  const std::string item = "answers every recorded cloud";
  const auto good = examine<ForeignMap>({.stage = "map_server", .input = file}, MapFault::none);
  EXPECT_THAT(failed(good), IsEmpty());
  EXPECT_NE(std::ranges::find(good.items, item, &conformance::Item::name), good.items.end());
  // Each cloud that is passed over in silence is waited for.
  const auto silent = examine<ForeignMap>({.stage = "map_server", .input = file, .timeout_s = 0.4},
                                          MapFault::silent);
  EXPECT_THAT(failed(silent), Contains(item));
}

TEST(ConformMapServer, ARecordingWithoutCloudsIsASentence) {
  const auto context = join(runtime::hold_private_domain().value());
  const std::string file = testing::TempDir() + "conform_nothing.mcap";
  EXPECT_TRUE(recording::Writer::create(*recording::create_file(file, true))->close());
  for (const std::string stage : {"map_server", "tracker", "path_search"}) {
    const auto report = conformance::conform(*context, {.stage = stage, .input = file});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.code(), ErrorCode::invalid_input);
    EXPECT_THAT(report.error().message, testing::HasSubstr("no messages on"));
  }
}

}  // namespace
}  // namespace goshawk::conformance_test
