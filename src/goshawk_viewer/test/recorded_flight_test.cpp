// What a page draws of a recording, from messages that are written here.
#include "goshawk/viewer/recorded_flight.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/moving_boxes.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/recording/writer.hpp"
#include "goshawk/runtime/message_type.hpp"

namespace goshawk::viewer {
namespace {

namespace msg = goshawk_msgs::msg;

constexpr std::int64_t kBegin_ns = 1'000'000'000'000;

std::int64_t after(double t_s) {
  return kBegin_ns + std::int64_t(1e9 * t_s);
}

/// A recording of a vehicle that rests, with movers and predictions.
class Recorded : public testing::Test {
 protected:
  Recorded() : writer_(recording::Writer::create(*recording::create_file(path_, true)).value()) {
    for (const auto& [topic, type] : {std::pair{"/odom", "nav_msgs/msg/Odometry"},
                                      {"/movers", "goshawk_msgs/msg/MovingBoxes"},
                                      {"/obstacles", "goshawk_msgs/msg/PredictedObstacles"}}) {
      const auto schema = writer_.add_schema(type, "ros2msg", "");
      channels_[topic] =
          writer_.add_channel({.schema_id = schema, .topic = topic, .message_encoding = "cdr"});
    }
    nav_msgs::msg::Odometry odometry;
    odometry.header(conversions::make_header(kBegin_ns));
    odometry.child_frame_id("base_link");
    conversions::fill_msg(RigidBodyState{}, odometry);
    write("/odom", 0.0, odometry);
  }
  ~Recorded() override { std::filesystem::remove(path_); }

  template <typename Message>
  void write(const char* topic, double t_s, const Message& message) {
    const auto bytes = runtime::encode(message);
    const auto stamp_ns = std::uint64_t(after(t_s));
    ASSERT_TRUE(writer_.write({channels_.at(topic), 0, stamp_ns, stamp_ns, bytes}));
  }

  void write_person(double t_s, double x_m, const char* frame = "map") {
    msg::MovingBoxes m;
    conversions::fill_msg(
        {{.id = 7, .kind = "person", .position_map = {x_m, 4.0, 0.9}, .half_m = {0.3, 0.4, 0.9}}},
        m);
    m.header(conversions::make_header(after(t_s), frame));
    write("/movers", t_s, m);
  }

  /// @param w of the orientation: 0 is no rotation
  void write_prediction(double t_s, double w, const char* frame = "map") {
    msg::TrackPiece piece;
    piece.duration(2.0);
    piece.control_points({conversions::to_point({4, 4, 0.9}), conversions::to_point({6, 4, 0.9})});
    msg::PredictedObstacle obstacle;
    obstacle.id(7);
    obstacle.half_extents(conversions::to_vector({0.3, 0.4, 0.9}));
    obstacle.orientation().w(w);
    obstacle.track({piece});
    obstacle.error(0.1);
    obstacle.error_rate(0.2);
    obstacle.valid_until(1.5);
    msg::PredictedObstacles m;
    m.header(conversions::make_header(after(t_s), frame));
    m.obstacles({obstacle});
    write("/obstacles", t_s, m);
  }

  RecordedFlight read() {
    EXPECT_TRUE(writer_.close());
    auto reader = recording::Reader::open(path_).value();
    return RecordedFlight::read(reader).value();
  }

  std::string path_ =
      (std::filesystem::temp_directory_path() / fmt::format("goshawk-recorded-flight-{}", getpid()))
          .string();
  recording::Writer writer_;
  std::map<std::string, std::uint16_t> channels_;
};

TEST_F(Recorded, WhatMovedIsOnTheFlightsClock) {
  write_person(0.5, 4.0);
  write_person(0.55, 4.1);  // sooner than a page shows
  write_person(1.0, 5.0);
  write_prediction(1.25, 1.0);
  const RecordedFlight recorded = read();
  EXPECT_THAT(recorded.complaints(), testing::IsEmpty());
  const auto flight = recorded.flight("test");
  ASSERT_EQ(flight.movers.size(), 2);
  EXPECT_NEAR(flight.movers[0].t_s, 0.5, 1e-6);
  EXPECT_NEAR(flight.movers[1].t_s, 1.0, 1e-6);
  ASSERT_EQ(flight.movers[1].boxes.size(), 1);
  const MovingBox& person = flight.movers[1].boxes[0];
  EXPECT_EQ(person.id, 7);
  EXPECT_EQ(person.kind, "person");
  EXPECT_EQ(person.position_map, Vec3(5.0, 4.0, 0.9));
  EXPECT_EQ(person.half_m, Vec3(0.3, 0.4, 0.9));

  ASSERT_EQ(flight.predictions.size(), 1);
  EXPECT_NEAR(flight.predictions[0].t_s, 1.25, 1e-6);
  const auto& box = flight.predictions[0].boxes.at(0);
  EXPECT_EQ(box.half_extents_m, Vec3(0.3, 0.4, 0.9));
  ASSERT_EQ(box.track.size(), 1);
  EXPECT_EQ(box.track[0].duration_s, 2.0);
  EXPECT_EQ(box.track[0].control_points_map.back(), Vec3(6.0, 4.0, 0.9));
  EXPECT_EQ(box.error_m, 0.1);
  EXPECT_EQ(box.error_rate_m_s, 0.2);
  EXPECT_EQ(box.valid_until_s, 1.5);
  EXPECT_TRUE(flight.check());
}

TEST_F(Recorded, BoxesThatCannotBeDrawnAreNamedAndLeftOut) {
  write_person(0.5, std::nan(""));
  write_person(1.0, 4.0, "odom");
  write_prediction(1.5, 0.0);
  write_prediction(2.0, 1.0, "odom");
  const RecordedFlight recorded = read();
  const auto flight = recorded.flight("test");
  EXPECT_TRUE(flight.movers.empty());
  EXPECT_TRUE(flight.predictions.empty());
  using testing::HasSubstr;
  EXPECT_THAT(recorded.complaints(),
              testing::ElementsAre(HasSubstr("/movers: moving box 7"), HasSubstr("odom"),
                                   HasSubstr("/obstacles: a quaternion"), HasSubstr("odom")));
}

}  // namespace
}  // namespace goshawk::viewer
