#include "markers.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/visualization/polytope_mesh.hpp"
#include "goshawk/visualization/speed_color.hpp"

namespace goshawk::visualization {
namespace {

enum Kind : std::int32_t { kLineStrip = 4, kLineList = 5, kCubes = 6, kTriangles = 11 };

const Vec3 kCorridorColor(0.22, 0.77, 0.91);
constexpr double kMostSteps = 20000.0;  // of one trajectory

std_msgs::msg::ColorRGBA color(const Vec3& rgb, double alpha = 1.0) {
  std_msgs::msg::ColorRGBA c;
  c.r(float(rgb.x()));
  c.g(float(rgb.y()));
  c.b(float(rgb.z()));
  c.a(float(alpha));
  return c;
}

Marker make_marker(const std::string& name, Kind kind, double scale_m, std::int64_t stamp_ns) {
  Marker m;
  m.header(conversions::make_header(stamp_ns));
  m.ns(name);
  m.type(kind);
  m.pose().orientation().w(1.0);
  m.scale().x(scale_m);
  m.scale().y(scale_m);
  m.scale().z(scale_m);
  m.color(color(Vec3::Ones()));
  return m;
}

bool is_surface(const BitGrid& occupied, Index3 i) {
  const auto open = [&](int x, int y, int z) {
    const Index3 neighbour = i + Index3{x, y, z};
    return !occupied.contains(neighbour) || !occupied.get(neighbour);
  };
  return open(1, 0, 0) || open(-1, 0, 0) || open(0, 1, 0) || open(0, -1, 0) || open(0, 0, 1) ||
         open(0, 0, -1);
}

std::vector<Index3> surface_of(const BitGrid& occupied) {
  std::vector<Index3> surface;
  const Index3 size = occupied.size();
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const Index3 i{x, y, z};
        if (occupied.get(i) && is_surface(occupied, i)) surface.push_back(i);
      }
    }
  }
  return surface;
}

// Evenly from the start to the end, at most step_s apart unless that takes too many.
std::vector<FlatState> sampled(const Trajectory& trajectory, double step_s) {
  const double duration_s = trajectory.duration_s();
  const int steps = int(std::clamp(std::ceil(duration_s / step_s), 1.0, kMostSteps));
  std::vector<FlatState> states;
  for (int k = 0; k <= steps; ++k) states.push_back(trajectory.sample(duration_s * k / steps));
  return states;
}

}  // namespace

Marker voxel_marker(const map_server::RawVoxels& voxels, int most, std::int64_t stamp_ns) {
  const GridGeometry& geometry = voxels.geometry;
  Marker m = make_marker("obstacles", kCubes, geometry.resolution_m, stamp_ns);
  const auto surface = surface_of(voxels.occupied);
  const auto limit = std::size_t(std::max(1, most));
  const std::size_t step = std::max<std::size_t>(1, (surface.size() + limit - 1) / limit);
  for (std::size_t k = 0; k < surface.size(); k += step) {
    const double rise = double(surface[k].z) / std::max(1, geometry.size.z - 1);
    m.points().push_back(conversions::to_point(geometry.center(surface[k])));
    m.colors().push_back(color(Vec3(0.28, 0.33, 0.43) + rise * Vec3(0.38, 0.38, 0.38)));
  }
  return m;
}

Marker line_marker(const std::string& name, const std::vector<Vec3>& points, double width_m,
                   const Vec3& rgb, std::int64_t stamp_ns) {
  Marker m = make_marker(name, kLineStrip, width_m, stamp_ns);
  m.color(color(rgb));
  m.points(conversions::to_points(points));
  return m;
}

Marker face_marker(const std::vector<Polytope>& polytopes, std::int64_t stamp_ns) {
  Marker m = make_marker("corridor", kTriangles, 1.0, stamp_ns);
  m.color(color(kCorridorColor, 0.1));
  for (const auto& polytope : polytopes) {
    const Mesh mesh = closed_mesh(polytope);
    for (const auto& face : mesh.faces) {
      for (std::size_t k = 1; k + 1 < face.size(); ++k) {
        for (const std::size_t corner : {face[0], face[k], face[k + 1]}) {
          m.points().push_back(conversions::to_point(mesh.corners[corner]));
        }
      }
    }
  }
  return m;
}

Marker edge_marker(const std::string& name, const std::vector<Polytope>& polytopes, double width_m,
                   std::int64_t stamp_ns) {
  Marker m = make_marker(name, kLineList, width_m, stamp_ns);
  m.color(color(kCorridorColor, 0.7));
  for (const auto& polytope : polytopes) {
    const Mesh mesh = closed_mesh(polytope);
    for (const auto& [from, to] : edges(mesh)) {
      m.points().push_back(conversions::to_point(mesh.corners[from]));
      m.points().push_back(conversions::to_point(mesh.corners[to]));
    }
  }
  return m;
}

Marker trajectory_marker(const Trajectory& trajectory, double v_max_m_s, std::int64_t stamp_ns) {
  Marker m = make_marker("trajectory", kLineStrip, 0.06, stamp_ns);
  for (const FlatState& s : sampled(trajectory, 0.05)) {
    m.points().push_back(conversions::to_point(s.position));
    m.colors().push_back(color(speed_color(s.velocity.norm() / v_max_m_s)));
  }
  return m;
}

nav_msgs::msg::Path path_line(const Trajectory& trajectory, double step_s, std::int64_t stamp_ns) {
  nav_msgs::msg::Path path;
  path.header(conversions::make_header(stamp_ns));
  for (const FlatState& s : sampled(trajectory, step_s)) {
    geometry_msgs::msg::PoseStamped pose;
    pose.header(path.header());
    pose.pose().position(conversions::to_point(s.position));
    pose.pose().orientation().w(1.0);
    path.poses().push_back(std::move(pose));
  }
  return path;
}

}  // namespace goshawk::visualization
