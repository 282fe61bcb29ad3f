#include "markers.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/flight_report/polytope_mesh.hpp"

namespace goshawk::viewer_bridge {
namespace {

using visualization_msgs::msg::Marker;

enum Kind : std::int32_t { kLineStrip = 4, kLineList = 5, kCubes = 6, kTriangles = 11 };

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

bool is_surface(const BitGrid& grid, Index3 i) {
  return !grid.test({i.x + 1, i.y, i.z}) || !grid.test({i.x - 1, i.y, i.z}) ||
         !grid.test({i.x, i.y + 1, i.z}) || !grid.test({i.x, i.y - 1, i.z}) ||
         !grid.test({i.x, i.y, i.z + 1}) || !grid.test({i.x, i.y, i.z - 1});
}

std::vector<Index3> surface_of(const BitGrid& grid) {
  std::vector<Index3> surface;
  const Index3 size = grid.size();
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (grid.get({x, y, z}) && is_surface(grid, {x, y, z})) surface.push_back({x, y, z});
      }
    }
  }
  return surface;
}

// Slow to fast, as the flight's page has it (page/theme.js).
Vec3 speed_color(double ratio) {
  static const Vec3 kStops[] = {{0.18, 0.42, 1.0},
                                {0.50, 0.34, 0.96},
                                {0.82, 0.26, 0.70},
                                {0.93, 0.28, 0.34},
                                {1.0, 0.52, 0.10}};
  const double s = 4.0 * std::clamp(ratio, 0.0, 1.0);
  const int k = std::min(3, int(s));
  return kStops[k] + (s - k) * (kStops[k + 1] - kStops[k]);
}

}  // namespace

Marker voxel_marker(const VoxelGrid& grid, int most, std::int64_t stamp_ns) {
  Marker m = make_marker("obstacles", kCubes, grid.geometry.resolution_m, stamp_ns);
  const auto surface = surface_of(grid.occupied);
  const std::size_t step = surface.size() / std::size_t(std::max(1, most)) + 1;
  for (std::size_t k = 0; k < surface.size(); k += step) {
    const double rise = double(surface[k].z) / std::max(1, grid.geometry.size.z - 1);
    m.points().push_back(conversions::to_point(grid.geometry.center(surface[k])));
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

std::vector<Marker> corridor_markers(const std::vector<Polytope>& polytopes,
                                     std::int64_t stamp_ns) {
  Marker faces = make_marker("corridor", kTriangles, 1.0, stamp_ns);
  Marker edges = make_marker("corridor edges", kLineList, 0.015, stamp_ns);
  faces.color(color({0.22, 0.77, 0.91}, 0.1));
  edges.color(color({0.22, 0.77, 0.91}, 0.7));
  for (const auto& polytope : polytopes) {
    for (const auto& polygon : flight_report::face_polygons(polytope, 1e3)) {
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        edges.points().push_back(conversions::to_point(polygon[k]));
        edges.points().push_back(conversions::to_point(polygon[(k + 1) % polygon.size()]));
        if (k == 0 || k + 1 == polygon.size()) continue;
        for (const auto& p : {polygon[0], polygon[k], polygon[k + 1]}) {
          faces.points().push_back(conversions::to_point(p));
        }
      }
    }
  }
  return {std::move(faces), std::move(edges)};
}

Marker trajectory_marker(const Trajectory& trajectory, double v_max_m_s, std::int64_t stamp_ns) {
  Marker m = make_marker("trajectory", kLineStrip, 0.06, stamp_ns);
  const double duration_s = trajectory.duration_s();
  const int steps = std::clamp(int(std::ceil(duration_s / 0.05)), 1, 20000);
  for (int k = 0; k <= steps; ++k) {
    const FlatState s = trajectory.sample(duration_s * k / steps);
    m.points().push_back(conversions::to_point(s.position));
    m.colors().push_back(color(speed_color(s.velocity.norm() / v_max_m_s)));
  }
  return m;
}

}  // namespace goshawk::viewer_bridge
