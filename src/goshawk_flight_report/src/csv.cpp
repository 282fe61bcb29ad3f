#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "file.hpp"
#include "goshawk/flight_report/files.hpp"
#include "goshawk/visualization/polytope_mesh.hpp"

namespace goshawk::flight_report {

namespace {

constexpr double kMostRows = 1e7;

/// fmt writes the shortest text that reads back as the same number, whatever the locale.
template <typename... Values>
void append(std::string& text, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
}

void append_columns(std::string& text, const Vec3& v) {
  append(text, ",{},{},{}", v.x(), v.y(), v.z());
}

void append_trajectory(std::string& text, const Leg& leg, std::size_t number, int steps) {
  const double duration_s = leg.trajectory.duration_s();
  for (int k = 0; k <= steps; ++k) {
    const double t_s = duration_s * k / steps;
    const FlatState state = leg.trajectory.sample(t_s);
    append(text, "{},{}", number, leg.start_t_s + t_s);
    for (const Vec3& v : {state.position, state.velocity, state.acceleration, state.jerk}) {
      append_columns(text, v);
    }
    append(text, ",{}\n", leg.yaw_at(t_s));
  }
}

/// A mesh as rows of a PLY file.
struct PlyRows {
  std::string vertices;
  std::string faces;
  std::size_t vertex_count = 0;
  std::size_t face_count = 0;

  void add(const visualization::Mesh& mesh, std::size_t leg, std::size_t polytope) {
    for (const Vec3& p : mesh.corners) append(vertices, "{} {} {}\n", p.x(), p.y(), p.z());
    for (const auto& face : mesh.faces) {
      append(faces, "{}", face.size());
      for (const std::size_t corner : face) append(faces, " {}", vertex_count + corner);
      append(faces, " {} {}\n", leg, polytope);
    }
    vertex_count += mesh.corners.size();
    face_count += mesh.faces.size();
  }
};

}  // namespace

Status write_flown_csv(const Flight& flight, const std::filesystem::path& file) {
  if (auto status = flight.check(); !status) return status;
  std::string text = "t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,qw,qx,qy,qz\n";
  for (const FlownSample& s : flight.flown) {
    append(text, "{}", s.t_s);
    append_columns(text, s.position_map);
    append_columns(text, s.velocity_map);
    append(text, ",{}", s.q_map_base.w());
    append_columns(text, s.q_map_base.vec());
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
  PlyRows rows;
  for (std::size_t leg = 0; leg < flight.legs.size(); ++leg) {
    const auto& corridor = flight.legs[leg].corridor;
    for (std::size_t k = 0; k < corridor.size(); ++k) {
      rows.add(visualization::closed_mesh(corridor[k]), leg, k);
    }
  }
  return write_file(file,
                    fmt::format("ply\nformat ascii 1.0\n"
                                "comment corridor of a Goshawk flight, frame map, metres\n"
                                "element vertex {}\n"
                                "property double x\nproperty double y\nproperty double z\n"
                                "element face {}\n"
                                "property list uchar int vertex_indices\n"
                                "property int leg\nproperty int polytope\nend_header\n{}{}",
                                rows.vertex_count, rows.face_count, rows.vertices, rows.faces));
}

}  // namespace goshawk::flight_report
