#include "../component/memory_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "goshawk/core/random.hpp"

namespace goshawk::navigator {
namespace {

StoredMemory in_flight() {
  StoredMemory stored{.memory = {.state = State::flying,
                                 .newest_id = 1'790'000'000'123,
                                 .goal = {Vec3(3.5, 6.1, 1.1), -0.75, 0.8},
                                 .open = true,
                                 .reason = {ErrorCode::not_at_start, "0.9 m away"}},
                      .legs = std::vector<PublishedLeg>(2)};
  stored.legs[0].yaw(0.5);
  stored.legs[1].map_version(9);
  stored.legs[1].nominal().implementation("bezier-scale");
  return stored;
}

class MemoryFile : public testing::Test {
 protected:
  MemoryFile() { std::filesystem::create_directories(folder_); }
  ~MemoryFile() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("goshawk_memory_" + std::to_string(::getpid()));
  std::string path_ = folder_ / "navigator.memory";
};

TEST_F(MemoryFile, GivesBackWhatWasWrittenLast) {
  ASSERT_TRUE(write_memory(path_, {}));
  ASSERT_TRUE(write_memory(path_, in_flight()));
  const auto read = read_memory(path_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->memory.state, State::flying);
  EXPECT_EQ(read->memory.newest_id, 1'790'000'000'123u);
  EXPECT_EQ(read->memory.goal.position_map, Vec3(3.5, 6.1, 1.1));
  EXPECT_EQ(read->memory.goal.yaw_rad, -0.75);
  EXPECT_EQ(read->memory.goal.v_max_m_s, 0.8);
  EXPECT_TRUE(read->memory.open);
  EXPECT_EQ(read->memory.reason.code, ErrorCode::not_at_start);
  EXPECT_EQ(read->memory.reason.message, "0.9 m away");
  EXPECT_EQ(read->legs, in_flight().legs);
  EXPECT_FALSE(std::filesystem::exists(path_ + ".new"));
}

TEST_F(MemoryFile, ThatIsNotThereIsANavigatorThatHasDoneNothing) {
  const auto read = read_memory(path_);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->memory.state, State::idle);
  EXPECT_TRUE(read->legs.empty());
}

TEST_F(MemoryFile, ThatIsAFolderCannotBeRead) {
  EXPECT_EQ(read_memory(folder_).code(), ErrorCode::io_failed);
}

TEST_F(MemoryFile, ThatCannotBeWrittenIsSaid) {
  const auto status = write_memory(folder_ / "no" / "folder", in_flight());
  EXPECT_EQ(status.code(), ErrorCode::io_failed);
  EXPECT_NE(status.error().message.find("no/folder"), std::string::npos);
}

TEST_F(MemoryFile, ThatIsCutOffOrChangedAnywhereIsNotUsed) {
  const auto whole = to_bytes(in_flight());
  ASSERT_TRUE(from_bytes(whole));
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    EXPECT_EQ(from_bytes({whole.begin(), whole.begin() + std::ptrdiff_t(size)}).code(),
              ErrorCode::io_failed);
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    auto changed = whole;
    changed[at] ^= 0x10;
    EXPECT_FALSE(from_bytes(changed)) << at;
  }
  std::ofstream(path_) << "something else\n";
  EXPECT_NE(read_memory(path_).error().message.find(path_), std::string::npos);
}

}  // namespace
}  // namespace goshawk::navigator
