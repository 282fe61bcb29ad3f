#include "lies.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"

namespace goshawk::hostile {

namespace msg = goshawk_msgs::msg;

namespace {

constexpr double kReach_m = 100.0;  // of the polytope that is claimed to be free
constexpr double kSlow = 0.5;       // of the limits, so that the certificate surely holds

Polytope anywhere(const Vec3& from, const Vec3& to) {
  return Polytope::box(from.cwiseMin(to).array() - kReach_m, from.cwiseMax(to).array() + kReach_m);
}

// A quintic from rest to rest is fastest in its middle: 15/8 of its mean speed. Its largest
// acceleration is 10/sqrt(3) times the length over the square of the time.
double duration_s(const Vec3& from, const Vec3& to, const msg::Limits& limits) {
  const double length_m = (to - from).norm();
  return std::max({1.0, 15.0 / 8.0 * length_m / (kSlow * limits.v_max()),
                   std::sqrt(5.7735 * length_m / (kSlow * limits.a_max()))});
}

msg::VoxelGrid filled(msg::VoxelGrid grid, std::uint64_t grown) {
  std::ranges::fill(grid.grown(), grown);
  std::ranges::fill(grid.raw(), grown);
  grid.known().clear();
  grid.version(grid.version() + 1'000'000);
  return grid;
}

sensor_msgs::msg::PointCloud2 cloud(const std::vector<Vec3>& points, std::int64_t stamp_ns) {
  constexpr std::uint8_t kFloat32 = 7;
  sensor_msgs::msg::PointCloud2 m;
  m.header(conversions::make_header(stamp_ns));
  for (std::uint32_t k = 0; k < 3; ++k) {
    sensor_msgs::msg::PointField field;
    field.name(std::string(1, "xyz"[k]));
    field.offset(k * sizeof(float));
    field.datatype(kFloat32);
    field.count(1);
    m.fields().push_back(field);
  }
  m.height(1);
  m.width(std::uint32_t(points.size()));
  m.point_step(3 * sizeof(float));
  m.row_step(m.width() * m.point_step());
  m.data().resize(m.row_step());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3f point = points[k].cast<float>();
    std::memcpy(m.data().data() + k * m.point_step(), point.data(), m.point_step());
  }
  return m;
}

}  // namespace

msg::PlanRequest request_for(std::uint64_t id, const Vec3& from, const Vec3& to,
                             std::int64_t now_ns) {
  PlanRequest request;
  request.id = id;
  request.start.position = from;
  request.goal.position = to;
  auto m = conversions::to_msg(request);
  m.header(conversions::make_header(now_ns));
  return m;
}

msg::BezierTrajectory straight(const msg::PlanRequest& request, const Vec3& from, const Vec3& to) {
  FlatState start, goal;
  start.position = from;
  goal.position = to;
  Trajectory trajectory;
  trajectory.pieces.push_back(
      BezierPiece::between(start, goal, duration_s(from, to, request.limits())));
  msg::BezierTrajectory m;
  m.header(request.header());
  m.request(request);
  m.implementation("impostor");
  m.map_version(1);
  m.pieces(conversions::to_msg(trajectory));
  m.polytopes(conversions::to_msg(std::vector{anywhere(from, to)}));
  return m;
}

msg::CommittedTrajectory commit(const msg::BezierTrajectory& nominal, std::uint64_t map_version,
                                std::int64_t start_ns) {
  msg::CommittedTrajectory m;
  m.header(nominal.header());
  m.start_time(conversions::to_stamp(start_ns));
  m.map_version(map_version);
  m.nominal(nominal);
  return m;
}

msg::Corridor wide_corridor(const msg::PlanRequest& request) {
  const Vec3 from = conversions::from_msg(request.start().position());
  const Vec3 to = conversions::from_msg(request.goal().position());
  msg::Corridor m;
  m.header(request.header());
  m.request(request);
  m.implementation("impostor");
  m.map_version(1);
  m.waypoints({conversions::to_point(from), conversions::to_point(to)});
  m.polytopes(conversions::to_msg(std::vector{anywhere(from, to)}));
  return m;
}

msg::VoxelGrid all_free(msg::VoxelGrid grid) {
  return filled(std::move(grid), 0);
}

msg::VoxelGrid all_blocked(msg::VoxelGrid grid) {
  return filled(std::move(grid), ~std::uint64_t{0});
}

msg::VoxelGridUpdate freeing_update(const msg::VoxelGrid& grid) {
  constexpr unsigned kWord = 64, kBrick = 8;
  const auto bricks = [](unsigned size, unsigned edge) { return (size + edge - 1) / edge; };
  msg::VoxelGridUpdate update;
  update.header(grid.header());
  update.from_version(grid.version());
  update.to_version(grid.version() + 1);
  msg::VoxelBrick brick;
  brick.grown().assign(64, 0);
  brick.known().assign(64, ~std::uint64_t{0});
  if (!grid.raw().empty()) brick.raw().assign(64, 0);
  for (unsigned z = 0; z < bricks(grid.size_z(), kBrick); ++z) {
    for (unsigned y = 0; y < bricks(grid.size_y(), kBrick); ++y) {
      for (unsigned x = 0; x < bricks(grid.size_x(), kWord); ++x) {
        brick.word_x(x);
        brick.brick_y(y);
        brick.brick_z(z);
        update.bricks().push_back(brick);
      }
    }
  }
  return update;
}

nav_msgs::msg::Odometry moved(nav_msgs::msg::Odometry odometry, const Vec3& by,
                              std::int64_t ahead_ns) {
  auto& p = odometry.pose().pose().position();
  p.x(p.x() + by.x());
  p.y(p.y() + by.y());
  p.z(p.z() + by.z());
  const std::int64_t stamp_ns = conversions::to_ns(odometry.header().stamp());
  odometry.header().stamp(conversions::to_stamp(stamp_ns + ahead_ns));
  return odometry;
}

msg::AttitudeSetpoint full_tilt(std::int64_t now_ns) {
  AttitudeSetpoint setpoint;
  setpoint.thrust_n = 20.0;
  setpoint.q_map_base = Quaternion(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitX()));
  msg::AttitudeSetpoint m;
  m.header(conversions::make_header(now_ns));
  conversions::fill_msg(setpoint, m);
  return m;
}

msg::FallbackStop stop_elsewhere(const Vec3& from, const Vec3& to, std::int64_t now_ns) {
  msg::FallbackStop m;
  m.header(conversions::make_header(now_ns));
  conversions::fill_msg(
      FallbackStop{.step_s = 1.0, .states = {{.position = from}, {.position = to}}}, m);
  return m;
}

sensor_msgs::msg::PointCloud2 cloud_of_wall(const Vec3& eye, const Vec3& to,
                                            std::int64_t stamp_ns) {
  const Vec3 ahead = (to - eye).stableNormalized();
  const Vec3 aside = Vec3::UnitZ().cross(ahead).stableNormalized();
  std::vector<Vec3> points;
  constexpr int kHalf = 30;
  constexpr double kStep_m = 0.05;
  for (int i = -kHalf; i <= kHalf; ++i) {
    for (int j = -kHalf; j <= kHalf; ++j) {
      points.push_back(eye + ahead + kStep_m * (i * aside + j * Vec3::UnitZ()));
    }
  }
  return cloud(points, stamp_ns);
}

sensor_msgs::msg::PointCloud2 cloud_of_nothing(const Vec3& eye, std::int64_t stamp_ns) {
  constexpr int kPoints = 20'000;
  constexpr double kRange_m = 7.5;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Vec3> points;
  for (int k = 0; k < kPoints; ++k) {  // a Fibonacci sphere
    const double z = 1.0 - 2.0 * (k + 0.5) / kPoints, r = std::sqrt(1.0 - z * z);
    points.push_back(eye + kRange_m * Vec3(r * std::cos(golden * k), r * std::sin(golden * k), z));
  }
  return cloud(points, stamp_ns);
}

sensor_msgs::msg::PointCloud2 cloud_of_garbage(const Vec3& eye, std::int64_t stamp_ns) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::vector<Vec3> points;
  for (const double x : {kNan, kInfinite, -kInfinite, 1e30, -1e30, 1e9, 3e38}) {
    points.insert(points.end(), {{x, x, x}, eye + Vec3(x, 0, 0), {eye.x(), x, eye.z()}});
  }
  return cloud(points, stamp_ns);
}

}  // namespace goshawk::hostile
