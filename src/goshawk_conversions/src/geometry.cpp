#include "goshawk/conversions/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace goshawk::conversions {

builtin_interfaces::msg::Time to_stamp(std::int64_t time_ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  builtin_interfaces::msg::Time stamp;
  const std::int64_t rest = ((time_ns % kSecond) + kSecond) % kSecond;
  stamp.sec(std::int32_t((time_ns - rest) / kSecond));
  stamp.nanosec(std::uint32_t(rest));
  return stamp;
}

std::int64_t to_ns(const builtin_interfaces::msg::Time& stamp) {
  return std::int64_t{stamp.sec()} * 1'000'000'000 + stamp.nanosec();
}

std_msgs::msg::Header make_header(std::int64_t stamp_ns, std::string_view frame) {
  std_msgs::msg::Header header;
  header.stamp(to_stamp(stamp_ns));
  header.frame_id(std::string(frame));
  return header;
}

Status check_frame(const std_msgs::msg::Header& header, std::string_view frame,
                   std::string_view what) {
  if (header.frame_id() == frame) return success();
  return fail(
      ErrorCode::wrong_frame,
      fmt::format("{} is in frame '{}', but must be in '{}': transform it before sending it", what,
                  header.frame_id(), frame));
}

Vec3 from_msg(const geometry_msgs::msg::Point& m) {
  return {m.x(), m.y(), m.z()};
}
Vec3 from_msg(const geometry_msgs::msg::Vector3& m) {
  return {m.x(), m.y(), m.z()};
}

geometry_msgs::msg::Point to_point(const Vec3& v) {
  geometry_msgs::msg::Point m;
  m.x(v.x());
  m.y(v.y());
  m.z(v.z());
  return m;
}

geometry_msgs::msg::Vector3 to_vector(const Vec3& v) {
  geometry_msgs::msg::Vector3 m;
  m.x(v.x());
  m.y(v.y());
  m.z(v.z());
  return m;
}

std::vector<Vec3> from_msg(const std::vector<geometry_msgs::msg::Point>& points) {
  std::vector<Vec3> out;
  out.reserve(points.size());
  for (const auto& p : points) out.push_back(from_msg(p));
  return out;
}

std::vector<geometry_msgs::msg::Point> to_points(const std::vector<Vec3>& points) {
  std::vector<geometry_msgs::msg::Point> out;
  out.reserve(points.size());
  for (const auto& p : points) out.push_back(to_point(p));
  return out;
}

FlatState from_msg(const goshawk_msgs::msg::FlatState& m) {
  return {from_msg(m.position()), from_msg(m.velocity()), from_msg(m.acceleration()), Vec3::Zero()};
}

goshawk_msgs::msg::FlatState to_msg(const FlatState& s) {
  goshawk_msgs::msg::FlatState m;
  m.position(to_point(s.position));
  m.velocity(to_vector(s.velocity));
  m.acceleration(to_vector(s.acceleration));
  return m;
}

Result<Polytope> from_msg(const goshawk_msgs::msg::Polytope& m) {
  const std::size_t faces = m.offsets().size();
  if (m.normals().size() != 3 * faces) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("a polytope has {} components of normals and {} offsets: it needs three "
                    "components for each offset",
                    m.normals().size(), faces));
  }
  Polytope p;
  p.half_spaces.reserve(faces);
  for (std::size_t i = 0; i < faces; ++i) {
    const double* n = m.normals().data() + 3 * i;
    p.add({n[0], n[1], n[2]}, m.offsets()[i]);
  }
  p.valid_from_s = m.valid_from();
  p.valid_until_s = m.valid_until();
  return p;
}

goshawk_msgs::msg::Polytope to_msg(const Polytope& p) {
  goshawk_msgs::msg::Polytope m;
  m.normals().reserve(3 * p.half_spaces.size());
  m.offsets().reserve(p.half_spaces.size());
  for (const HalfSpace& face : p.half_spaces) {
    m.normals().insert(m.normals().end(), face.normal.begin(), face.normal.end());
    m.offsets().push_back(face.offset_m);
  }
  m.valid_from(p.valid_from_s);
  m.valid_until(p.valid_until_s);
  return m;
}

Result<std::vector<Polytope>> from_msg(const std::vector<goshawk_msgs::msg::Polytope>& m) {
  std::vector<Polytope> polytopes;
  polytopes.reserve(m.size());
  for (const auto& item : m) {
    auto polytope = from_msg(item);
    if (!polytope) return polytope.error();
    polytopes.push_back(*std::move(polytope));
  }
  return polytopes;
}

std::vector<goshawk_msgs::msg::Polytope> to_msg(const std::vector<Polytope>& polytopes) {
  std::vector<goshawk_msgs::msg::Polytope> m;
  m.reserve(polytopes.size());
  for (const auto& polytope : polytopes) m.push_back(to_msg(polytope));
  return m;
}

Trajectory from_msg(const std::vector<goshawk_msgs::msg::BezierPiece>& m) {
  Trajectory t;
  t.pieces.reserve(m.size());
  for (const auto& item : m) {
    BezierPiece& piece = t.pieces.emplace_back();
    piece.duration_s = item.duration();
    piece.polytope = int(std::min<std::uint32_t>(item.polytope(), INT32_MAX));
    for (int j = 0; j < 6; ++j) {
      piece.control_points.col(j) = from_msg(item.control_points()[std::size_t(j)]);
    }
  }
  return t;
}

std::vector<goshawk_msgs::msg::BezierPiece> to_msg(const Trajectory& t) {
  std::vector<goshawk_msgs::msg::BezierPiece> m(t.pieces.size());
  for (std::size_t k = 0; k < m.size(); ++k) {
    m[k].duration(t.pieces[k].duration_s);
    m[k].polytope(std::uint32_t(t.pieces[k].polytope));
    for (int j = 0; j < 6; ++j) {
      m[k].control_points()[std::size_t(j)] = to_point(t.pieces[k].control_points.col(j));
    }
  }
  return m;
}

goshawk_msgs::msg::Certificate to_msg(const Certificate& c) {
  goshawk_msgs::msg::Certificate m;
  m.position(c.position_m);
  m.validity(c.validity_s);
  m.velocity(c.velocity_m_s);
  m.acceleration(c.acceleration_m_s2);
  m.continuity_position(c.continuity_position_m);
  m.continuity_velocity(c.continuity_velocity_m_s);
  m.continuity_acceleration(c.continuity_acceleration_m_s2);
  m.start(c.start_m);
  m.goal(c.goal_m);
  m.jerk(c.jerk_m_s3);
  m.start_excess_velocity(c.start_excess_m_s);
  m.start_excess_acceleration(c.start_excess_m_s2);
  m.start_excess_time(c.start_excess_s);
  return m;
}

}  // namespace goshawk::conversions
