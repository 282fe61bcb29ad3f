#include <charconv>
#include <cmath>

#include "file.hpp"
#include "goshawk/flight_report/files.hpp"
#include "goshawk/flight_report/polytope_mesh.hpp"

namespace goshawk::flight_report {

namespace {

constexpr double kMostRows = 1e7;

/// Shortest text that reads back as the same number, whatever the locale.
void append(std::string& text, double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  text.append(digits, end);
}

void append(std::string& text, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) {
    text += ',';
    append(text, v[axis]);
  }
}

void append_trajectory(std::string& text, const Leg& leg, std::size_t number, int steps) {
  const double duration_s = leg.trajectory.duration_s();
  for (int k = 0; k <= steps; ++k) {
    const double t_s = duration_s * k / steps;
    const FlatState state = leg.trajectory.sample(t_s);
    text += std::to_string(number) + ',';
    append(text, leg.start_t_s + t_s);
    for (const Vec3& v : {state.position, state.velocity, state.acceleration, state.jerk}) {
      append(text, v);
    }
    text += ',';
    append(text, leg.yaw_at(t_s));
    text += '\n';
  }
}

}  // namespace

Status write_flown_csv(const Flight& flight, const std::filesystem::path& file) {
  if (auto status = flight.check(); !status) return status;
  std::string text = "t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,qw,qx,qy,qz\n";
  for (const FlownSample& s : flight.flown) {
    append(text, s.t_s);
    append(text, s.position_map);
    append(text, s.velocity_map);
    text += ',';
    append(text, s.q_map_base.w());
    append(text, Vec3(s.q_map_base.vec()));
    text += '\n';
  }
  return write_file(file, text);
}

Status write_trajectory_csv(const Flight& flight, const std::filesystem::path& file,
                            double step_s) {
  if (auto status = flight.check(); !status) return status;
  if (!(step_s > 0.0)) return fail(ErrorCode::invalid_input, "the step is not above zero");
  double rows = 0.0;
  for (const Leg& leg : flight.legs) rows += leg.trajectory.duration_s() / step_s + 2.0;
  if (!(rows < kMostRows)) {
    return fail(ErrorCode::invalid_input, "more than 10^7 rows: use a longer step");
  }
  std::string text =
      "leg,t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,ax_m_s2,ay_m_s2,az_m_s2,jx_m_s3,jy_m_s3,jz_m_s3,"
      "yaw_rad\n";
  for (std::size_t i = 0; i < flight.legs.size(); ++i) {
    const Leg& leg = flight.legs[i];
    if (leg.trajectory.pieces.empty()) continue;
    const double steps = std::ceil(leg.trajectory.duration_s() / step_s);
    append_trajectory(text, leg, i, std::max(1, int(steps)));
  }
  return write_file(file, text);
}

Status write_corridor_ply(const Flight& flight, const std::filesystem::path& file) {
  if (auto status = flight.check(); !status) return status;
  std::string vertices;
  std::string faces;
  std::size_t vertex_count = 0;
  std::size_t face_count = 0;
  for (std::size_t leg = 0; leg < flight.legs.size(); ++leg) {
    for (std::size_t k = 0; k < flight.legs[leg].corridor.size(); ++k) {
      const Mesh mesh = closed_mesh(flight.legs[leg].corridor[k]);
      for (const Vec3& p : mesh.corners) {
        append(vertices, p.x());
        for (int axis = 1; axis < 3; ++axis) append(vertices += ' ', p[axis]);
        vertices += '\n';
      }
      for (const auto& face : mesh.faces) {
        faces += std::to_string(face.size());
        for (const std::size_t corner : face) faces += ' ' + std::to_string(vertex_count + corner);
        faces += ' ' + std::to_string(leg) + ' ' + std::to_string(k) + '\n';
      }
      vertex_count += mesh.corners.size();
      face_count += mesh.faces.size();
    }
  }
  return write_file(
      file,
      "ply\nformat ascii 1.0\ncomment corridor of a Goshawk flight, frame map, metres\n"
      "element vertex " +
          std::to_string(vertex_count) +
          "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
          std::to_string(face_count) +
          "\nproperty list uchar int vertex_indices\nproperty int leg\n"
          "property int polytope\nend_header\n" +
          vertices + faces);
}

}  // namespace goshawk::flight_report
