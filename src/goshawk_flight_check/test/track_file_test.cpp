#include "goshawk/flight_check/track_file.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "goshawk/flight_check/planned_track.hpp"
#include "worlds.hpp"

namespace goshawk::flight_check {
namespace {

using testing::HasSubstr;

class TrackFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) const {
    std::ofstream(file_) << text;
    return file_;
  }
  void TearDown() override { std::filesystem::remove(file_); }

  std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                ("goshawk_track_" + std::to_string(getpid()) + ".csv");
};

TEST_F(TrackFile, ReadsAFlownTableWhateverTheOrderOfItsColumns) {
  const auto track = read_flown_csv(write(
      "qz,t_s,x_m,y_m,z_m,vx_m_s,qw,qx,qy\n0,0.5,1,2,3,9,1,0,0\n1,0.75,1.5,2,-3e-1,9,0,0,0\n"));
  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->size(), 2U);
  EXPECT_EQ((*track)[1].t_s, 0.75);
  EXPECT_EQ((*track)[1].position_map, Vec3(1.5, 2, -0.3));
  EXPECT_EQ((*track)[1].q_map_base.z(), 1.0);
}

TEST_F(TrackFile, SaysWhatIsWrongAndInWhichLine) {
  EXPECT_EQ(read_flown_csv("no/such/file.csv").code(), ErrorCode::io_failed);
  EXPECT_EQ(read_flown_csv(write("")).code(), ErrorCode::io_failed);
  auto track = read_flown_csv(write("t_s,x_m,y_m,z_m,qw,qx,qy\n"));
  EXPECT_EQ(track.code(), ErrorCode::invalid_input);
  EXPECT_THAT(track.error().message, HasSubstr("no column qz"));
  const std::string head = "t_s,x_m,y_m,z_m,qw,qx,qy,qz\n";
  for (const char* line : {"0,1,2,x,1,0,0,0", "0,1,2", "0,1,2,,1,0,0,0", "0,1,2,3 4,1,0,0,0"}) {
    track = read_flown_csv(write(head + "0,1,2,3,1,0,0,0\n" + line + "\n"));
    EXPECT_EQ(track.code(), ErrorCode::invalid_input) << line;
    EXPECT_THAT(track.error().message, HasSubstr("line 3")) << line;
  }
  // Numbers that are none any more are for the judge to refuse.
  const auto nan = read_flown_csv(write(head + "0,nan,2,3,1,0,0,0\n"));
  ASSERT_TRUE(nan);
  EXPECT_EQ(FlightCheck::from_tree(test::tree_of({{5, 0, 0}})).value().judge(*nan).code(),
            ErrorCode::invalid_input);
}

TEST_F(TrackFile, ReadsPlannedLegsApartWithTheAttitudeOfTheirAcceleration) {
  const auto legs = read_planned_csv(
      write("leg,t_s,x_m,y_m,z_m,ax_m_s2,ay_m_s2,az_m_s2\n1,0,0,0,1,9.80665,0,0\n1,1,1,0,1,0,0,0\n"
            "2,3,1,0,1,0,0,0\n"));
  ASSERT_TRUE(legs) << legs.error().message;
  ASSERT_EQ(legs->size(), 2U);
  EXPECT_EQ((*legs)[0].size(), 2U);
  const Vec3 up = (*legs)[0][0].q_map_base * Vec3::UnitZ();
  EXPECT_NEAR(up.x(), std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(up.z(), std::sqrt(0.5), 1e-9);
}

TEST_F(TrackFile, TurnsAPlannedLegByItsYawColumnElseAsTold) {
  const std::string head = "leg,t_s,x_m,y_m,z_m,ax_m_s2,ay_m_s2,az_m_s2";
  const auto heading = [](const Sample& s) {
    const Vec3 x = s.q_map_base * Vec3::UnitX();
    return std::atan2(x.y(), x.x());
  };
  const auto with =
      read_planned_csv(write(head + ",yaw_rad\n1,0,0,0,1,0,0,0,0.25\n1,1,1,0,1,0,0,0,-1.5\n"), 9.0);
  ASSERT_TRUE(with) << with.error().message;
  EXPECT_NEAR(heading((*with)[0][0]), 0.25, 1e-12);
  EXPECT_NEAR(heading((*with)[0][1]), -1.5, 1e-12);
  const auto without = read_planned_csv(write(head + "\n1,0,0,0,1,0,0,0\n"), 0.75);
  ASSERT_TRUE(without) << without.error().message;
  EXPECT_NEAR(heading((*without)[0][0]), 0.75, 1e-12);
}

TEST(Payload, OfAMessageGivesTheSameVerdictAsTheTreeAndBadBytesNone) {
  auto tree = test::tree_of(test::wall_at_x(10, 5));
  std::ostringstream bytes;
  tree->updateInnerOccupancy();
  tree->toMaxLikelihood();
  tree->writeBinaryData(bytes);
  const std::string payload = bytes.str();
  const std::vector<Sample> track{test::at(0.0, {0, 0, 0}), test::at(1.0, {0.7, 0, 0})};
  const auto there = FlightCheck::from_payload(payload, test::kVoxel_m).value().judge(track);
  const auto here = FlightCheck::from_tree(std::move(tree)).value().judge(track);
  EXPECT_FALSE(there->touched);
  EXPECT_EQ(there->clearance_m, here->clearance_m);
  EXPECT_NEAR(there->clearance_m, 0.15, 2e-3);
  for (std::size_t cut = 0; cut < payload.size(); ++cut) {
    EXPECT_FALSE(FlightCheck::from_payload(payload.substr(0, cut), test::kVoxel_m));
  }
  EXPECT_EQ(FlightCheck::from_payload("", 0.1).code(), ErrorCode::map_empty);
  EXPECT_EQ(FlightCheck::from_payload(payload, 0.0).code(), ErrorCode::map_malformed);
  EXPECT_EQ(FlightCheck::from_payload(payload, NAN).code(), ErrorCode::map_malformed);
}

TEST(Gaps, AreNamedWhereTheyAreTooLongToJudge) {
  std::vector<Sample> track;
  for (int i = 0; i < 100; ++i) track.push_back({.t_s = 0.01 * i});
  EXPECT_TRUE(check_gaps(track));
  EXPECT_TRUE(check_gaps({}));
  track.push_back({.t_s = 0.99 + kLongestGap_s});
  EXPECT_TRUE(check_gaps(track));
  track.push_back({.t_s = 5.0});
  const auto status = check_gaps(track);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.code(), ErrorCode::tracking_lost);
  EXPECT_THAT(status.error().message, testing::HasSubstr("gap of 3.51"));
}

}  // namespace
}  // namespace goshawk::flight_check
