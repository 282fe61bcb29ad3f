// The top and the side picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "canvas.hpp"
#include "goshawk/flight_report/draw.hpp"
#include "goshawk/visualization/polytope_mesh.hpp"
#include "obstacle_image.hpp"
#include "plot_area.hpp"

namespace goshawk::flight_report {

namespace {

constexpr double kLeft_px = 84.0, kTop_px = 78.0, kBottom_px = 62.0, kLegend_px = 258.0;
constexpr double kMostWidth_px = 1400.0 - kLeft_px - kLegend_px;
constexpr double kMostHeight_px = 1150.0;
constexpr double kWholeHeight_m = 6.0;  // maps up to this high are shown from floor to ceiling
constexpr std::size_t kGuidePoints = 150;

constexpr Color kCorridor{0.16, 0.50, 0.72, 0.10};
constexpr Color kCorridorEdge{0.16, 0.50, 0.72, 0.60};
constexpr Color kRawPath{0.45, 0.30, 0.60};
constexpr Color kPruned{0.35, 0.40, 0.05};
constexpr Color kFlown{0.05, 0.05, 0.05};
constexpr Color kStart{0.10, 0.60, 0.25};
constexpr Color kGoal{0.80, 0.10, 0.10};
constexpr Color kWhite{1.0, 1.0, 1.0};

std::vector<FlatState> sampled(const Trajectory& trajectory, int steps) {
  std::vector<FlatState> states;
  if (trajectory.pieces.empty()) return states;
  const double duration_s = trajectory.duration_s();
  for (int k = 0; k <= steps; ++k) states.push_back(trajectory.sample(duration_s * k / steps));
  return states;
}

int steps_of(const Trajectory& trajectory) {
  return int(std::clamp(trajectory.duration_s() * 50.0, 50.0, 4000.0));
}

void include_polyline(std::vector<Vec3>& points, const std::vector<Vec3>& corners) {
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    for (int k = 0; k < 10; ++k)
      points.push_back(corners[i] + (corners[i + 1] - corners[i]) * k / 10);
  }
  if (!corners.empty()) points.push_back(corners.back());
}

/// The way that was taken, or the best that is known of it.
std::vector<Vec3> way(const Flight& flight) {
  std::vector<Vec3> points;
  for (const FlownSample& s : flight.flown) points.push_back(s.position_map);
  for (const Leg& leg : flight.legs) {
    if (!flight.flown.empty()) break;
    for (const FlatState& s : sampled(leg.trajectory, 200)) points.push_back(s.position);
    if (!leg.trajectory.pieces.empty()) continue;
    include_polyline(points, leg.waypoints_map.empty() ? leg.raw_path_map : leg.waypoints_map);
  }
  return points;
}

/// At most kGuidePoints of the way, evenly.
std::vector<Vec3> guide_of(const std::vector<Vec3>& points) {
  std::vector<Vec3> guide;
  const std::size_t step =
      std::max<std::size_t>(1, (points.size() + kGuidePoints - 1) / kGuidePoints);
  for (std::size_t i = 0; i < points.size(); i += step) guide.push_back(points[i]);
  return guide;
}

struct Bounds {
  Vec3 lower = Vec3::Constant(1e300);
  Vec3 upper = Vec3::Constant(-1e300);
  bool empty() const { return !(lower.x() <= upper.x()); }
  void include(const Vec3& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
};

Bounds bounds_of_flight(const Flight& flight) {
  Bounds bounds;
  for (const FlownSample& s : flight.flown) bounds.include(s.position_map);
  for (const Leg& leg : flight.legs) {
    for (const Vec3& p : leg.raw_path_map) bounds.include(p);
    for (const Vec3& p : leg.waypoints_map) bounds.include(p);
    for (const FlatState& s : sampled(leg.trajectory, 200)) bounds.include(s.position);
  }
  return bounds;
}

/// What the picture shows along one axis: the flight with some room around it, no more than the
/// map where there is one, but always the flight.
Interval window(const Flight& flight, const Bounds& around, int axis) {
  const VoxelGrid* grid = flight.obstacles != nullptr ? flight.obstacles : flight.grown;
  Interval map{-1e7, 1e7};
  if (grid != nullptr) {
    map = {grid->geometry.origin_map[axis], grid->geometry.upper_corner_map()[axis]};
  }
  if (around.empty()) return grid != nullptr ? map : Interval{-1.0, 1.0};
  if (axis == 2 && grid != nullptr && map.length() <= kWholeHeight_m) {
    map.include(around.lower[axis]);
    map.include(around.upper[axis]);
    return map;
  }
  const double extent = (around.upper - around.lower).maxCoeff();
  const double room_m =
      axis == 2 ? std::clamp(0.1 * extent, 0.5, 1.5) : std::max(1.5, 0.2 * extent);
  const double edge_m = 2.0 * flight.body_radius_m;
  Interval shown{std::max(map.lo, around.lower[axis] - room_m),
                 std::min(map.hi, around.upper[axis] + room_m)};
  shown.include(around.lower[axis] - edge_m);
  shown.include(around.upper[axis] + edge_m);
  return shown;
}

/// Room for the plot, with equal scales unless the picture would be flat as a ribbon.
struct Sheet {
  PlotArea area;
  int stretch = 1;  // of v against u
  int width_px = 0;
  int height_px = 0;
};

Sheet lay_out(const Interval& u, const Interval& v, bool may_stretch) {
  Sheet sheet;
  const double ratio = v.length() / u.length();
  if (may_stretch) {
    sheet.stretch = int(std::clamp(std::ceil(300.0 / (ratio * kMostWidth_px)), 1.0, 5.0));
  }
  double width = kMostWidth_px;
  double height = width * ratio * sheet.stretch;
  if (height > kMostHeight_px) {
    width *= kMostHeight_px / height;
    height = kMostHeight_px;
  }
  // Beyond some thinness the scales part, so that there is something to see.
  width = std::max(width, 240.0);
  height = std::max(height, 240.0);
  sheet.area = {{kLeft_px, kTop_px, std::round(width), std::round(height)}, u, v};
  sheet.width_px = int(kLeft_px + std::round(width) + kLegend_px);
  sheet.height_px = int(kTop_px + std::max(std::round(height), 310.0) + kBottom_px);
  return sheet;
}

class MapPicture {
 public:
  MapPicture(const Flight& flight, const View& view, const Sheet& sheet)
      : flight_(flight), view_(view), area_(sheet.area), canvas_(sheet.width_px, sheet.height_px) {
    for (const Leg& leg : flight.legs) {
      if (!leg.trajectory.pieces.empty()) {
        fastest_m_s_ = std::max(fastest_m_s_, leg.trajectory.peaks().speed_m_s);
      }
    }
    fastest_m_s_ = std::max(fastest_m_s_, flight.limits.v_max_m_s);
  }

  Status draw(const Sheet& sheet, const std::filesystem::path& png) {
    canvas_.clip(area_.place);
    obstacles();
    canvas_.unclip();
    draw_axes(canvas_, area_, {axis_label(view_.u, 1), axis_label(view_.v, sheet.stretch)});
    canvas_.clip(area_.place);
    for (const Leg& leg : flight_.legs) corridor(leg);
    for (const Leg& leg : flight_.legs) paths(leg);
    for (const Leg& leg : flight_.legs) trajectory(leg);
    flown();
    for (const Leg& leg : flight_.legs) waypoints(leg);
    ends();
    canvas_.unclip();
    title();
    legend();
    return canvas_.save(png);
  }

 private:
  static std::string axis_label(int axis, int stretch) {
    std::string label = std::string(1, "xyz"[axis]) + " [m]";
    if (stretch > 1) label += ", stretched " + std::to_string(stretch) + " times";
    return label;
  }

  Vec2 pixel(const Vec3& p) const { return area_.pixel(p[view_.u], p[view_.v]); }

  std::vector<Vec2> pixels(const std::vector<Vec3>& points) const {
    std::vector<Vec2> result;
    for (const Vec3& p : points) result.push_back(pixel(p));
    return result;
  }

  void obstacles() {
    const ObstacleImage cells =
        obstacle_image(flight_.obstacles, flight_.grown, view_, area_.u, area_.v,
                       guide_of(way(flight_)), flight_.body_radius_m);
    if (cells.image.pixels.empty()) return;
    const Vec2 corner = area_.pixel(cells.u.lo, cells.v.hi);
    const Vec2 opposite = area_.pixel(cells.u.hi, cells.v.lo);
    canvas_.image({corner.x(), corner.y(), opposite.x() - corner.x(), opposite.y() - corner.y()},
                  cells.image);
  }

  void corridor(const Leg& leg) {
    for (const Polytope& polytope : leg.corridor) {
      std::vector<Vec2> corners;
      for (const auto& face : visualization::face_polygons(polytope)) {
        for (const Vec3& p : face) corners.push_back(pixel(p));
      }
      canvas_.polygon(visualization::convex_hull(std::move(corners)), kCorridor,
                      {kCorridorEdge, 1.1});
    }
  }

  void paths(const Leg& leg) {
    canvas_.polyline(pixels(leg.raw_path_map), {kRawPath, 1.0});
    canvas_.polyline(pixels(leg.waypoints_map), {kPruned, 1.4});
  }

  void waypoints(const Leg& leg) {
    for (const Vec3& p : leg.waypoints_map) canvas_.dot(pixel(p), 3.2, kWhite, {kPruned, 1.6});
  }

  void trajectory(const Leg& leg) {
    const auto states = sampled(leg.trajectory, steps_of(leg.trajectory));
    for (std::size_t i = 0; i + 1 < states.size(); ++i) {
      // A little longer than the step: no seams between neighbours.
      const Vec2 from = pixel(states[i].position);
      const Vec2 step = pixel(states[i + 1].position) - from;
      const double speed = (states[i].velocity.norm() + states[i + 1].velocity.norm()) / 2.0;
      canvas_.polyline(std::array{from, Vec2(from + 1.3 * step)},
                       {speed_color(speed / fastest_m_s_), 4.6});
    }
  }

  void flown() {
    std::vector<Vec2> track;
    for (const FlownSample& s : flight_.flown) {
      const Vec2 p = pixel(s.position_map);
      if (track.empty() || (p - track.back()).norm() > 0.7) track.push_back(p);
    }
    canvas_.polyline(track, {kFlown, 1.5, 6.0});
  }

  /// Start and goals: of the legs, or of the flown track where there are none.
  void ends() {
    std::vector<Vec3> stops;
    for (const Leg& leg : flight_.legs) {
      const auto states = sampled(leg.trajectory, 1);
      std::vector<Vec3> line = leg.waypoints_map.empty() ? leg.raw_path_map : leg.waypoints_map;
      if (line.empty()) {
        for (const FlatState& s : states) line.push_back(s.position);
      }
      if (line.empty()) continue;
      if (stops.empty()) stops.push_back(line.front());
      stops.push_back(line.back());
    }
    if (stops.empty() && !flight_.flown.empty()) {
      stops = {flight_.flown.front().position_map, flight_.flown.back().position_map};
    }
    const bool tour = stops.size() > 2;
    for (std::size_t i = stops.size(); i-- > 0;) {
      const std::string name = i == 0 ? "S" : tour ? std::to_string(i) : "G";
      canvas_.dot(pixel(stops[i]), 10.0, i == 0 ? kStart : kGoal, {kWhite, 2.0});
      canvas_.text(pixel(stops[i]), name,
                   {.size_px = 12.0, .align = Align::center, .color = kWhite, .bold = true});
    }
  }

  void title() {
    const double left = area_.place.left;
    canvas_.text({left, 26.0}, flight_.title,
                 {.size_px = 20.0, .color = {0.1, 0.1, 0.12}, .bold = true});
    double length_m = 0.0, duration_s = 0.0, top_m_s = 0.0;
    for (const Leg& leg : flight_.legs) {
      if (leg.trajectory.pieces.empty()) continue;
      length_m += leg.trajectory.length_m();
      duration_s += leg.trajectory.duration_s();
      top_m_s = std::max(top_m_s, leg.trajectory.peaks().speed_m_s);
    }
    if (duration_s <= 0.0) return;
    char text[160];
    std::snprintf(
        text, sizeof text,
        "planned %.2f m in %.2f s, mean %.2f m/s, top %.2f m/s (limits %.4g m/s, %.4g m/s\u00b2)",
        length_m, duration_s, length_m / duration_s, top_m_s, flight_.limits.v_max_m_s,
        flight_.limits.a_max_m_s2);
    canvas_.text({left, 52.0}, text, {.size_px = 14.0});
  }

  void entry(double& y, const std::string& words, const std::function<void(double, double)>& sign) {
    const double x = area_.place.left + area_.place.width + 22.0;
    sign(x, y);
    canvas_.text({x + 42.0, y}, words, {});
    y += 24.0;
  }

  void line_entry(double& y, const std::string& words, const Stroke& stroke) {
    entry(y, words, [&](double x, double at) {
      canvas_.polyline(std::array{Vec2(x, at), Vec2(x + 32.0, at)}, stroke);
    });
  }

  void box_entry(double& y, const std::string& words, const Color& fill, const Color& edge) {
    entry(y, words, [&](double x, double at) {
      canvas_.rectangle({x, at - 7.0, 32.0, 14.0}, fill, {edge, 1.0});
    });
  }

  void legend() {
    double y = area_.place.top + 10.0;
    constexpr Color kEdge{0.6, 0.62, 0.65};
    const char* depth = view_.w == 2 ? "height" : "depth";
    const VoxelGrid* map = flight_.obstacles != nullptr ? flight_.obstacles : flight_.grown;
    if (map != nullptr) {
      box_entry(y, std::string("obstacle at the ") + depth + " flown", kBlocked, kEdge);
      box_entry(y, std::string("obstacle at another ") + depth, kElsewhere, kEdge);
      if (flight_.grown != nullptr) box_entry(y, "too close for the vehicle", kGrown, kEdge);
      if (!map->known.empty()) box_entry(y, "not measured", kUnknown, kEdge);
      y += 8.0;
    }
    const auto any = [&](auto&& has) {
      return std::any_of(flight_.legs.begin(), flight_.legs.end(), has);
    };
    if (any([](const Leg& leg) { return !leg.corridor.empty(); })) {
      box_entry(y, "safe corridor", {kCorridor.r, kCorridor.g, kCorridor.b, 0.2}, kCorridorEdge);
    }
    if (any([](const Leg& leg) { return !leg.raw_path_map.empty(); })) {
      line_entry(y, "voxel path", {kRawPath, 1.0});
    }
    if (any([](const Leg& leg) { return !leg.waypoints_map.empty(); })) {
      entry(y, "pruned path", [&](double x, double at) {
        canvas_.polyline(std::array{Vec2(x, at), Vec2(x + 32.0, at)}, {kPruned, 1.4});
        canvas_.dot({x + 16.0, at}, 3.2, kWhite, {kPruned, 1.6});
      });
    }
    if (!flight_.flown.empty()) line_entry(y, "flown", {kFlown, 1.5, 6.0});
    if (any([](const Leg& leg) { return !leg.trajectory.pieces.empty(); })) speed_bar(y);
  }

  void speed_bar(double y) {
    const double x = area_.place.left + area_.place.width + 22.0;
    constexpr double kWidth = 190.0;
    canvas_.text({x, y + 12.0}, "planned trajectory, speed [m/s]", {});
    for (int k = 0; k < 190; ++k) {
      canvas_.rectangle({x + k, y + 26.0, 1.6, 12.0}, speed_color((k + 0.5) / kWidth),
                        {{0, 0, 0, 0}, 0.1});
    }
    for (int k = 0; k <= 4; ++k) {
      char text[32];
      std::snprintf(text, sizeof text, "%.2f", fastest_m_s_ * k / 4.0);
      canvas_.text({x + kWidth * k / 4.0, y + 50.0}, text,
                   {.size_px = 12.0, .align = Align::center});
    }
  }

  const Flight& flight_;
  View view_;
  PlotArea area_;
  Canvas canvas_;
  double fastest_m_s_ = 0.0;
};

Status draw(const Flight& flight, const View& view, const Bounds& bounds, bool may_stretch,
            const std::filesystem::path& png) {
  const Sheet sheet =
      lay_out(window(flight, bounds, view.u), window(flight, bounds, view.v), may_stretch);
  return MapPicture(flight, view, sheet).draw(sheet, png);
}

}  // namespace

Status draw_top(const Flight& flight, const std::filesystem::path& png) {
  if (auto status = flight.check(); !status) return status;
  return draw(flight, {0, 1, 2}, bounds_of_flight(flight), false, png);
}

Status draw_side(const Flight& flight, const std::filesystem::path& png) {
  if (auto status = flight.check(); !status) return status;
  const Bounds bounds = bounds_of_flight(flight);
  const Interval x = window(flight, bounds, 0), y = window(flight, bounds, 1);
  const bool along_x = x.length() >= y.length();
  return draw(flight, along_x ? View{0, 2, 1} : View{1, 2, 0}, bounds, true, png);
}

}  // namespace goshawk::flight_report
