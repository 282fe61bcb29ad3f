#include "goshawk/mission_messages/messages.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "memory.hpp"

namespace goshawk::mission {
namespace {

using testing::HasSubstr;

Mission survey() {
  return {.id = 7,
          .client = "test",
          .name = "survey",
          .waypoints = {{.position_map = {1, 2, 3}, .yaw_rad = 0.5, .hold_s = 2.0},
                        {.position_map = {4, 5, 6}, .v_max_m_s = 0.8, .pass_radius_m = 0.4},
                        {.position_map = {7, 8, 9}}}};
}

void expect_same(const Mission& a, const Mission& b) {
  EXPECT_EQ(std::tie(a.id, a.client, a.name), std::tie(b.id, b.client, b.name));
  ASSERT_EQ(a.waypoints.size(), b.waypoints.size());
  for (std::size_t i = 0; i < a.waypoints.size(); ++i) {
    const Waypoint &x = a.waypoints[i], &y = b.waypoints[i];
    EXPECT_EQ(x.position_map, y.position_map);
    EXPECT_EQ(std::tie(x.yaw_rad, x.hold_s, x.v_max_m_s, x.pass_radius_m),
              std::tie(y.yaw_rad, y.hold_s, y.v_max_m_s, y.pass_radius_m));
  }
}

TEST(MissionMessages, ComeBackAsTheyWereSent) {
  const auto back = from_msg(to_msg(survey(), 5));
  ASSERT_TRUE(back);
  expect_same(*back, survey());
}

TEST(MissionMessages, InAnotherFrameAreRefused) {
  auto m = to_msg(survey(), 5);
  m.header().frame_id("odom");
  EXPECT_EQ(from_msg(m).code(), ErrorCode::wrong_frame);
}

TEST(MissionMessages, ReadWhatTheNavigatorDoes) {
  namespace nav = goshawk_msgs::msg::NavigatorState_Constants;
  using Does = NavigatorNews::Does;
  goshawk_msgs::msg::NavigatorState m;
  for (const auto& [state, does] :
       std::vector<std::pair<std::uint8_t, Does>>{{nav::STATE_IDLE, Does::idle},
                                                  {nav::STATE_PLANNING, Does::pursues},
                                                  {nav::STATE_FLYING, Does::pursues},
                                                  {nav::STATE_ARRIVED, Does::arrived},
                                                  {nav::STATE_FAILED, Does::failed},
                                                  {nav::STATE_HELD, Does::held}}) {
    m.state(state);
    ASSERT_TRUE(from_msg(m));
    EXPECT_EQ(from_msg(m)->does, does);
  }
  m.state(77);
  EXPECT_FALSE(from_msg(m));
  EXPECT_EQ(mission_state_of(77), State::none);
}

class MissionMemory : public testing::Test {
 protected:
  MissionMemory() : folder_(testing::TempDir() + "mission_memory_" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder_);
  }
  ~MissionMemory() override { std::filesystem::remove_all(folder_); }
  std::string path() const { return folder_ + "/memory"; }

  std::string folder_;
  const Memory memory_{.mission = survey(),
                       .state = State::failed,
                       .next = 1,
                       .taken = true,
                       .sent_after_ns = 1'700'000'000'000'000'000,
                       .reason = {ErrorCode::no_path, "a wall"}};
};

TEST_F(MissionMemory, ComesBackAsItWasWritten) {
  ASSERT_TRUE(write_memory(path(), memory_));
  const auto back = read_memory(path());
  ASSERT_TRUE(back) << back.error().message;
  expect_same(back->mission, memory_.mission);
  EXPECT_EQ(std::tie(back->state, back->next, back->taken, back->sent_after_ns),
            std::tie(memory_.state, memory_.next, memory_.taken, memory_.sent_after_ns));
  EXPECT_EQ(back->reason.code, ErrorCode::no_path);
  EXPECT_EQ(back->reason.message, "a wall");
}

TEST_F(MissionMemory, OfNoFileIsThatOfAStageThatHasFlownNothing) {
  const auto memory = read_memory(path());
  ASSERT_TRUE(memory);
  EXPECT_EQ(memory->state, State::none);
}

TEST_F(MissionMemory, ThatWasCutOffOrChangedAnywhereIsNotUsed) {
  ASSERT_TRUE(write_memory(path(), memory_));
  std::ifstream file(path(), std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(file), {});
  for (std::size_t at = 1; at < whole.size(); at += 7) {
    for (const bool cut : {true, false}) {
      std::string bad = cut ? whole.substr(0, at) : whole;
      if (!cut) bad[at] = char(bad[at] ^ 1);
      std::ofstream(path(), std::ios::binary) << bad;
      EXPECT_EQ(read_memory(path()).code(), ErrorCode::io_failed) << at;
    }
  }
}

TEST_F(MissionMemory, WithAWaypointThatTheMissionHasNotIsNotUsed) {
  for (const std::size_t next : {std::size_t(3), std::size_t(99)}) {
    Memory bad = memory_;
    bad.next = next;
    EXPECT_EQ(from_bytes(to_bytes(bad)).code(), ErrorCode::io_failed);
  }
  EXPECT_EQ(from_bytes({1, 2, 3}).code(), ErrorCode::io_failed);
}

TEST_F(MissionMemory, ThatCannotBeWrittenNamesItsPath) {
  const auto status = write_memory("/nowhere/memory", memory_);
  EXPECT_EQ(status.code(), ErrorCode::io_failed);
  EXPECT_THAT(status.error().message, HasSubstr("/nowhere/memory cannot be written (No such file"));
}

}  // namespace
}  // namespace goshawk::mission
