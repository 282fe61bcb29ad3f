#include "bad_planners.hpp"

#include <algorithm>
#include <array>

namespace goshawk::guarded {
namespace {

constexpr double kFast_m_s = 1.5, kTooFast_m_s = 6.0;
constexpr double kSpacing_m = 0.4;

}  // namespace

std::string_view to_string(Fault fault) {
  constexpr std::array<std::string_view, kFaults> kWords{"blind", "jerky",     "overspeed",
                                                         "late",  "forgetful", "path"};
  return kWords.at(std::size_t(fault));
}

void BadPlanner::tick(GuardLab& lab) {
  if (lab.now_ns() < next_ns_) return;
  next_ns_ = lab.now_ns() + std::int64_t(random_.uniform(0.1, 0.8) * 1e9);
  const double latency_s =
      fault_ == Fault::late ? random_.uniform(0.1, 1.0) : random_.uniform(0.002, 0.02);
  lab.send(plan(lab), latency_s);
}

guard::Plan BadPlanner::plan(const GuardLab& lab) {
  std::vector<Vec3> points{lab.position()};
  if (fault_ == Fault::jerky) {
    for (int i = 4 + random_.below(12); i > 0; --i) {
      points.push_back(points.back() + Vec3(random_.uniform(-0.6, 1.0), random_.uniform(-1, 1),
                                            random_.uniform(-0.5, 0.5)));
    }
    return spline(points, random_.uniform(0.05, 0.5), lab.now_ns());
  }
  const Vec3 way = goal_map_ - points.front();
  const int steps = std::clamp(int(way.norm() / kSpacing_m), 1, 40);
  for (int i = 1; i <= steps; ++i) points.push_back(points.front() + double(i) / steps * way);
  if (fault_ == Fault::path) {
    return {.kind = guard::PlanKind::path, .shape = guard::Waypoints{std::move(points)}};
  }
  const double speed = fault_ == Fault::overspeed ? kTooFast_m_s : kFast_m_s;
  // A start in motion: without equal points there, the spline begins at its own speed.
  const bool at_rest = fault_ == Fault::forgetful || lab.velocity().norm() < 0.2;
  if (!at_rest) points.insert(points.begin(), points.front() - kSpacing_m * way.normalized());
  guard::Plan plan = spline(points, kSpacing_m / speed, lab.now_ns());
  if (!at_rest) {
    auto& s = std::get<guard::Bspline>(plan.shape);
    s.control_points_map.erase(s.control_points_map.begin(), s.control_points_map.begin() + 2);
    s.knots_s.erase(s.knots_s.begin(), s.knots_s.begin() + 2);
  }
  return plan;
}

guard::Plan BadPlanner::spline(const std::vector<Vec3>& points, double knot_s,
                               std::int64_t start_ns) const {
  guard::Bspline s{.degree = 3};
  for (int i = 0; i < 2; ++i) s.control_points_map.push_back(points.front());
  s.control_points_map.insert(s.control_points_map.end(), points.begin(), points.end());
  for (int i = 0; i < 2; ++i) s.control_points_map.push_back(points.back());
  for (std::size_t i = 0; i < s.control_points_map.size() + 4; ++i) {
    s.knots_s.push_back(knot_s * double(i));
  }
  return {.kind = guard::PlanKind::bspline, .start_time_ns = start_ns, .shape = std::move(s)};
}

}  // namespace goshawk::guarded
