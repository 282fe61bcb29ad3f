#include "goshawk/movers/movers_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace goshawk::movers {
namespace {

using testing::HasSubstr;

constexpr const char* kAll = R"(movers:
  - kind: person
    size: [0.5, 0.4, 1.8]
    start_s: 2
    walk: {points: [[0, 0, 0.9], [4, 0, 0.9]], speed_m_s: 1.4, pauses_s: [0, 1], repeat: loop}
  - size: [1, 0.1, 2]
    turn: {pivot: [3, 3, 1], arm: [0.5, 0, 0], amplitude_deg: 90, rate_rad_s: 1}
  - size: [1, 1, 1]
    slide: {center: [0, 5, 1], reach: [2, 0, 0], period_s: 4}
  - size: [0.8, 0.8, 0.8]
    trefoil: {center: [5, 0, 2], scale: [2, 3, 4], speed_m_s: 2}
  - size: [4, 1.8, 1.5]
    kind: vehicle
    track: {file: car.csv}
  - size: [0.3, 0.3, 3]
    still: {position: [7, 7, 1.5], yaw_deg: 45}
  - league: {count: 50, seed: 3, divisor_s: [10, 12]}
)";

class MoversFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::filesystem::path folder_;
};

std::string said(const std::string& text) {
  const auto movers = parse_movers("m.yaml", text);
  return movers ? "accepted" : movers.error().message;
}

std::string with_walk(const std::string& walk) {
  return "movers:\n  - size: [1, 1, 1]\n    walk: " + walk + "\n";
}

TEST_F(MoversFile, EveryMotionIsRead) {
  write("car.csv", "t_s,x_m,y_m,z_m,yaw_rad\n0,0,0,0.75,0\n2,4,0,0.75,0\n");
  const auto movers = read_movers(write("all.yaml", kAll));
  ASSERT_TRUE(movers) << movers.error().message;
  ASSERT_EQ(movers->size(), 56u);
  for (std::size_t i = 0; i < movers->size(); ++i) EXPECT_EQ((*movers)[i].id, i + 1);
  EXPECT_EQ((*movers)[0].kind, "person");
  EXPECT_EQ((*movers)[0].half_m, Vec3(0.25, 0.2, 0.9));
  EXPECT_TRUE((*movers)[0].at(2.0).position_map.isApprox(Vec3(0, 0, 0.9)));  // start_s
  EXPECT_TRUE((*movers)[2].at(1.0).position_map.isApprox(Vec3(2, 5, 1)));
  EXPECT_TRUE((*movers)[4].at(1.0).position_map.isApprox(Vec3(2, 0, 0.75)));
  EXPECT_TRUE((*movers)[4].at(1.0).velocity_map.isApprox(Vec3(2, 0, 0)));
  EXPECT_EQ((*movers)[5].top_speed_m_s(), 0.0);
}

TEST_F(MoversFile, TheTrackOfAFileIsCheckedWithItsLine) {
  const std::string file =
      write("m.yaml", "movers:\n  - size: [1, 1, 1]\n    track: {file: car.csv}\n");
  EXPECT_THAT(read_movers(file).error().message, HasSubstr("car.csv cannot be read"));
  write("car.csv", "t_s,x_m,y_m\n");
  EXPECT_THAT(read_movers(file).error().message, HasSubstr("column z_m is missing"));
  write("car.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,0,0,high\n");
  EXPECT_THAT(read_movers(file).error().message, HasSubstr("line 3: z_m: 'high' is not a number"));
  write("car.csv", "t_s,x_m,y_m,z_m\n0,0,0,0\n1,900,0,0\n");
  EXPECT_THAT(read_movers(file).error().message, HasSubstr("line 3: the track jumps to place 2"));
}

TEST_F(MoversFile, AMissingFileIsSaid) {
  EXPECT_EQ(read_movers(folder_ / "none.yaml").code(), ErrorCode::io_failed);
  EXPECT_EQ(read_movers(folder_).code(), ErrorCode::io_failed);
}

TEST(MoversText, FaultsAreNamedWithTheirLine) {
  EXPECT_THAT(said("movers:\n  - {size: [1, 1, 1], fly: {}}\n"),
              HasSubstr("m.yaml, line 2: a mover has no key 'fly'"));
  EXPECT_THAT(said("movers: 3\n"), HasSubstr("movers is not a list"));
  EXPECT_THAT(said("things: []\n"), HasSubstr("a file of movers has no key 'things'"));
  EXPECT_THAT(said("movers:\n  - size: [1, 1, 1]\n"), HasSubstr("line 2: a mover needs one of"));
  EXPECT_THAT(said("movers:\n  - size: [1, 1]\n    still: {position: [0, 0, 0]}\n"),
              HasSubstr("size is not three numbers"));
  EXPECT_THAT(said("movers:\n  - size: [1, 0, 1]\n    still: {position: [0, 0, 0]}\n"),
              HasSubstr("size is outside"));
  EXPECT_THAT(said("movers:\n  - size: [1, .nan, 1]\n    still: {position: [0, 0, 0]}\n"),
              HasSubstr("'.nan' is not a number"));
  EXPECT_THAT(said("movers:\n  - size: [1, +-1, 1]\n    still: {position: [0, 0, 0]}\n"),
              HasSubstr("'+-1' is not a number"));
  EXPECT_THAT(said("movers: [\n"), HasSubstr("it is not valid YAML"));
  EXPECT_THAT(said("movers:\n  - {league: {count: 50}, kind: x}\n"), HasSubstr("no key beside it"));
  EXPECT_THAT(said("movers:\n  - league: {count: 1.5}\n"), HasSubstr("whole number"));
  EXPECT_THAT(said(with_walk("{points: [[0, 0, 0], [1, 0, 0]]}")),
              HasSubstr("line 3: walk needs speed_m_s"));
  EXPECT_THAT(said(with_walk("{points: [[0, 0, 0], [1, 0, 0]], speed_m_s: 1, repeat: always}")),
              HasSubstr("repeat is not one of"));
  EXPECT_THAT(said(with_walk("{points: [[0, 0, 0], [1, 0, 0]], speed_m_s: 1, speed_m_s: 2}")),
              HasSubstr("speed_m_s is specified twice"));
}

TEST(MoversText, MotionsThatCannotBeAreRefused) {
  const std::string head = "movers:\n  - size: [1, 1, 1]\n    ";
  EXPECT_THAT(said(head + "turn: {pivot: [0, 0, 0], axis: [0, 0, 0], rate_rad_s: 1}\n"),
              HasSubstr("axis has no direction"));
  EXPECT_THAT(said(head + "turn: {pivot: [0, 0, 0], rate_rad_s: 100}\n"), HasSubstr("30 rad/s"));
  EXPECT_THAT(said(head + "slide: {center: [0, 0, 0], reach: [1, 0, 0], period_s: 0}\n"),
              HasSubstr("period_s is below"));
  EXPECT_THAT(said(head + "slide: {center: [0, 0, 0], reach: [1e5, 0, 0], period_s: 0.1}\n"),
              HasSubstr("1000 m/s"));
  EXPECT_THAT(said(head + "slide: {center: [1e7, 0, 0], reach: [1, 0, 0], period_s: 1}\n"),
              HasSubstr("beyond 1e6 m"));
  EXPECT_THAT(said(head + "still: {position: [0, 0, 0]}\n    start_s: 1e300\n"),
              HasSubstr("start_s is beyond"));
  EXPECT_THAT(said(head + "trefoil: {center: [0, 0, 0], scale: [1, -1, 1]}\n"),
              HasSubstr("scale is not above 0"));
}

TEST(MoversText, TenThousandMoversAreTheMost) {
  std::string text = "movers:\n  - league: {count: 10000}\n";
  EXPECT_EQ(said(text), "accepted");
  EXPECT_THAT(said(text + "  - {size: [1, 1, 1], still: {position: [0, 0, 0]}}\n"),
              HasSubstr("more than 10000 movers"));
}

}  // namespace
}  // namespace goshawk::movers
