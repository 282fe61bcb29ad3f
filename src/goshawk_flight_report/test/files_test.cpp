#include "goshawk/flight_report/files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "sample_flight.hpp"

namespace goshawk::flight_report::test {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("goshawk_flight_files_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

struct Table {
  std::string header;
  std::vector<std::vector<double>> rows;
};

Table read_csv(const fs::path& file) {
  std::ifstream in(file);
  Table table;
  std::getline(in, table.header);
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    table.rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');)
      table.rows.back().push_back(std::stod(cell));
  }
  return table;
}

Vec3 vec(const std::vector<double>& row, std::size_t at) {
  return {row[at], row[at + 1], row[at + 2]};
}

TEST_F(Files, TheFlownTrackReadsBackExactly) {
  SampleFlight sample;
  sample.flight.flown[0].position_map = Vec3(0.1, -1.0 / 3.0, 1e-17);
  ASSERT_TRUE(write_flown_csv(sample.flight, folder_ / "flown.csv").ok());
  const Table table = read_csv(folder_ / "flown.csv");
  EXPECT_EQ(table.header, "t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,qw,qx,qy,qz");
  ASSERT_EQ(table.rows.size(), sample.flight.flown.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const FlownSample& s = sample.flight.flown[i];
    const auto& row = table.rows[i];
    ASSERT_EQ(row.size(), 11U);
    EXPECT_EQ(row[0], s.t_s);
    EXPECT_EQ(vec(row, 1), s.position_map);
    EXPECT_EQ(vec(row, 4), s.velocity_map);
    EXPECT_EQ(row[7], s.q_map_base.w());
    EXPECT_EQ(vec(row, 8), Vec3(s.q_map_base.vec()));
  }
}

TEST_F(Files, TrajectoryRowsLieOnTheTrajectoriesOfTheirLegs) {
  const SampleFlight sample;
  ASSERT_TRUE(write_trajectory_csv(sample.flight, folder_ / "t.csv", 0.02).ok());
  const Table table = read_csv(folder_ / "t.csv");
  ASSERT_GT(table.rows.size(), 300U);
  double last_s[2] = {-1.0, -1.0};
  for (const auto& row : table.rows) {
    ASSERT_EQ(row.size(), 15U);
    const auto leg_number = std::size_t(row[0]);
    ASSERT_LT(leg_number, 2U);
    const Leg& leg = sample.flight.legs[leg_number];
    const double in_leg_s = std::clamp(row[1] - leg.start_t_s, 0.0, leg.trajectory.duration_s());
    const FlatState state = leg.trajectory.sample(in_leg_s);
    EXPECT_LT((vec(row, 2) - state.position).norm(), 1e-9);
    EXPECT_LT((vec(row, 5) - state.velocity).norm(), 1e-9);
    EXPECT_LT((vec(row, 8) - state.acceleration).norm(), 1e-6);
    EXPECT_NEAR(row[14], leg.yaw_at(row[1] - leg.start_t_s), 1e-9);
    last_s[leg_number] = row[1];
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const Leg& leg = sample.flight.legs[i];
    EXPECT_NEAR(last_s[i], leg.start_t_s + leg.trajectory.duration_s(), 1e-9);
  }
  EXPECT_EQ(write_trajectory_csv(sample.flight, folder_ / "t.csv", 0.0).code(),
            ErrorCode::invalid_input);
  EXPECT_EQ(write_trajectory_csv(sample.flight, folder_ / "t.csv", 1e-12).code(),
            ErrorCode::invalid_input);
}

TEST_F(Files, TheCorridorMeshLiesOnThePolytopes) {
  const SampleFlight sample;
  ASSERT_TRUE(write_corridor_ply(sample.flight, folder_ / "c.ply").ok());
  std::ifstream in(folder_ / "c.ply");
  std::string line;
  std::size_t vertex_count = 0, face_count = 0;
  while (std::getline(in, line) && line != "end_header") {
    std::sscanf(line.c_str(), "element vertex %zu", &vertex_count);
    std::sscanf(line.c_str(), "element face %zu", &face_count);
  }
  std::vector<Vec3> vertices(vertex_count);
  for (Vec3& p : vertices) in >> p.x() >> p.y() >> p.z();
  EXPECT_GE(face_count, 8U * 6U);
  for (std::size_t i = 0; i < face_count; ++i) {
    std::size_t corners = 0, leg = 0, polytope = 0;
    in >> corners;
    std::vector<std::size_t> indices(corners);
    for (auto& index : indices) in >> index;
    in >> leg >> polytope;
    ASSERT_TRUE(in.good() || in.eof());
    ASSERT_GE(corners, 3U);
    for (const auto index : indices) {
      ASSERT_LT(index, vertex_count);
      const double violation_m =
          sample.flight.legs.at(leg).corridor.at(polytope).violation(vertices[index]);
      EXPECT_NEAR(violation_m, 0.0, 1e-9);
    }
  }
}

TEST_F(Files, AFlightFolderHoldsAllOfIt) {
  const SampleFlight sample;
  ASSERT_TRUE(write_flight_folder(sample.flight, folder_).ok());
  for (const char* name :
       {"top.png", "side.png", "time.png", "flown.csv", "trajectory.csv", "corridor.ply"}) {
    EXPECT_GT(fs::file_size(folder_ / name), 100U) << name;
  }
}

TEST_F(Files, TablesThatCannotBeWrittenAreNamed) {
  const SampleFlight sample;
  const fs::path nowhere = folder_ / "missing" / "file";
  for (const auto& status :
       {write_flown_csv(sample.flight, nowhere), write_trajectory_csv(sample.flight, nowhere),
        write_corridor_ply(sample.flight, nowhere)}) {
    ASSERT_EQ(status.code(), ErrorCode::io_failed);
    EXPECT_NE(status.error().message.find("missing/file"), std::string::npos);
  }
  EXPECT_EQ(write_flown_csv({}, folder_ / "x.csv").code(), ErrorCode::invalid_input);
}

TEST_F(Files, ThePlanAtATimeIsThatOfTheLegFlownThen) {
  const SampleFlight sample;
  const auto& legs = sample.flight.legs;
  EXPECT_FALSE(sample.flight.planned_at(legs[0].start_t_s - 0.01).has_value());
  const double between_s = legs[0].start_t_s + legs[0].trajectory.duration_s() + 0.1;
  ASSERT_LT(between_s, legs[1].start_t_s);
  const auto waiting = sample.flight.planned_at(between_s);
  EXPECT_LT((waiting->position - legs[0].waypoints_map.back()).norm(), 1e-9);
  const auto second = sample.flight.planned_at(legs[1].start_t_s + 1.0);
  EXPECT_LT((second->position - legs[1].trajectory.sample(1.0).position).norm(), 1e-9);
}

// A vehicle that plans anew commits the same curve again with a later stop; the stamps of its start
// differ by microseconds. And what was committed for later may be replaced before it begins.
TEST_F(Files, ThePlanAtATimeIsTheNewestThatHadBegun) {
  SampleFlight sample;
  auto& legs = sample.flight.legs;
  Leg again = legs[0], replaced = legs[1], newest = legs[1];
  for (BezierPiece& piece : again.trajectory.pieces) piece.control_points.row(2).array() += 1.0;
  again.start_t_s -= 2e-6;
  replaced.start_t_s += 0.5;
  legs = {legs[0], again, replaced, newest};
  const auto early = sample.flight.planned_at(legs[0].start_t_s + 1.0);
  EXPECT_LT((early->position - again.trajectory.sample(1.0 + 2e-6).position).norm(), 1e-9);
  const auto late = sample.flight.planned_at(newest.start_t_s + 1.0);
  EXPECT_LT((late->position - newest.trajectory.sample(1.0).position).norm(), 1e-9);
}

}  // namespace
}  // namespace goshawk::flight_report::test
