#include "pictures.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace goshawk::navigator {
namespace {

using visualization_msgs::msg::Marker;

constexpr std::int32_t kLineList = 5;

// Each pair of planes meets in a line; what the other planes leave of it is an edge.
void add_edges(const Polytope& p, std::vector<geometry_msgs::msg::Point>& points) {
  for (int i = 0; i < p.faces(); ++i) {
    for (int j = i + 1; j < p.faces(); ++j) {
      const Vec3 n = p.A().row(i);
      const Vec3 m = p.A().row(j);
      const Vec3 direction = n.cross(m);
      if (direction.squaredNorm() < 1e-12) continue;
      Eigen::Matrix3d rows;
      rows << n.transpose(), m.transpose(), direction.transpose();
      const Vec3 origin = rows.inverse() * Vec3(p.b()[i], p.b()[j], 0.0);
      double lo = -1e9;
      double hi = 1e9;
      for (int k = 0; k < p.faces() && lo < hi; ++k) {
        if (k == i || k == j) continue;
        const double speed = p.A().row(k).dot(direction);
        const double room = p.b()[k] - p.A().row(k).dot(origin);
        if (std::abs(speed) < 1e-12) {
          if (room < -1e-9) hi = lo;
        } else if (speed > 0.0) {
          hi = std::min(hi, room / speed);
        } else {
          lo = std::max(lo, room / speed);
        }
      }
      if (hi - lo <= 1e-6 || lo < -1e8 || hi > 1e8) continue;
      points.push_back(conversions::to_point(origin + lo * direction));
      points.push_back(conversions::to_point(origin + hi * direction));
    }
  }
}

}  // namespace

nav_msgs::msg::Path path_line(const Trajectory& trajectory, std::int64_t stamp_ns, double step_s) {
  nav_msgs::msg::Path path;
  path.header(conversions::make_header(stamp_ns));
  const double duration_s = trajectory.duration_s();
  const int steps = int(std::ceil(duration_s / step_s));
  for (int i = 0; i <= steps; ++i) {
    geometry_msgs::msg::PoseStamped pose;
    pose.header(path.header());
    const double t_s = std::min(duration_s, step_s * i);
    pose.pose().position(conversions::to_point(trajectory.sample(t_s).position));
    pose.pose().orientation().w(1.0);
    path.poses().push_back(std::move(pose));
  }
  return path;
}

visualization_msgs::msg::MarkerArray corridor_markers(const CommittedTrajectory& committed,
                                                      std::int64_t stamp_ns) {
  visualization_msgs::msg::MarkerArray array;
  Marker edges;
  edges.header(conversions::make_header(stamp_ns));
  edges.ns("corridor");
  edges.type(kLineList);
  edges.pose().orientation().w(1.0);
  edges.scale().x(0.02);
  edges.color().r(0.2F);
  edges.color().g(0.6F);
  edges.color().b(0.9F);
  edges.color().a(0.8F);
  for (const auto& polytope : committed.flown_polytopes()) add_edges(polytope, edges.points());
  array.markers().push_back(std::move(edges));
  return array;
}

}  // namespace goshawk::navigator
