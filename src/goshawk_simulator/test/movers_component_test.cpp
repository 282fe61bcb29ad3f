// The component `movers` as it is installed, spun beside a node that listens.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/moving_boxes.hpp"
#include "goshawk/movers/movers_file.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/runtime/private_domain.hpp"

namespace goshawk::movers {
namespace {

using namespace goshawk::runtime;
using goshawk_msgs::msg::MovingBoxes;

constexpr double kMost_s = 120.0;  // of the machine's time

constexpr const char* kWorld = R"(movers:
  - kind: person
    size: [0.5, 0.4, 1.8]
    walk: {points: [[0, 0, 0.9], [4, 0, 0.9]], speed_m_s: 1.4}
  - size: [1, 0.1, 2]
    turn: {pivot: [3, 3, 1], arm: [0.5, 0, 0], amplitude_deg: 90, rate_rad_s: 1}
)";

class MoversComponentTest : public testing::Test {
 protected:
  MoversComponentTest() {
    static const int domain = hold_private_domain().value();
    setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
    ContextOptions options;
    options.domain = domain;
    context_ = Context::create(options).value();
    file_ = testing::TempDir() + "/goshawk_movers_component.yaml";
    std::ofstream(file_) << kWorld;
  }
  ~MoversComponentTest() override { std::filesystem::remove(file_); }

  RosArgs arguments(const std::string& file, const std::string& more = "rate_hz:=50") const {
    std::vector<std::string> words{"--ros-args", "-p", "movers_file:=" + file, "-p", more};
    return RosArgs::extract(words).value();
  }

  std::unique_ptr<Context> context_;
  std::string file_;
};

TEST_F(MoversComponentTest, EveryMessageSaysWhereEachMoverIsAtItsStamp) {
  Node node(*context_, "movers", arguments(file_, "movers_start_s:=1000"));
  Node listener(*context_, "listener");
  const auto movers = load_component("movers").value()->create(node);
  std::vector<MovingBoxes> heard;
  listener.subscribe<MovingBoxes>(
      "movers", Qos::best_effort(10),
      [&](const MovingBoxes& m, const MessageInfo&) { heard.push_back(m); });
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kMost_s);
  while (heard.size() < 5 && std::chrono::steady_clock::now() < end) {
    node.spin_some(0.02);
    listener.spin_some(0.02);
  }
  ASSERT_GE(heard.size(), 5u);
  const auto truth = read_movers(file_).value();
  for (const MovingBoxes& m : heard) {
    const auto boxes = conversions::from_msg(m);
    ASSERT_TRUE(boxes) << boxes.error().message;
    ASSERT_EQ(boxes->size(), 2u);
    const std::int64_t since_ns = conversions::to_ns(m.header().stamp()) - 1'000'000'000'000;
    for (std::size_t i = 0; i < 2; ++i) {
      const BoxState state = truth[i].at(1e-9 * double(since_ns));
      EXPECT_EQ((*boxes)[i].id, i + 1);
      EXPECT_EQ((*boxes)[i].kind, truth[i].kind);
      EXPECT_EQ((*boxes)[i].position_map, state.position_map);
      EXPECT_EQ((*boxes)[i].velocity_map, state.velocity_map);
      EXPECT_EQ((*boxes)[i].half_m, truth[i].half_m);
      EXPECT_EQ((*boxes)[i].position_error_m, 0.0);
    }
  }
}

TEST_F(MoversComponentTest, AFileThatIsWrongEndsTheStartWithItsLine) {
  std::ofstream(file_) << "movers:\n  - {size: [1, 1, 1]}\n";
  const auto create = [&](const std::string& file) {
    Node node(*context_, "movers", arguments(file));
    try {
      load_component("movers").value()->create(node);
    } catch (const StartupFault& fault) {
      return fault.error().message;
    }
    return std::string("accepted");
  };
  EXPECT_THAT(create(file_), testing::HasSubstr("line 2: a mover needs one of"));
  EXPECT_THAT(create("none.yaml"), testing::HasSubstr("cannot be read"));
  EXPECT_THAT(create("''"), testing::HasSubstr("movers_file is empty"));
}

}  // namespace
}  // namespace goshawk::movers
