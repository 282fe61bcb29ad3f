// The top and the side picture.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/flight_report/draw.hpp"
#include "goshawk/visualization/polytope_mesh.hpp"
#include "map_window.hpp"
#include "obstacle_image.hpp"
#include "plan_summary.hpp"
#include "plot.hpp"
#include "style.hpp"

namespace goshawk::flight_report {

namespace {

constexpr double kLeft_px = 84.0, kTop_px = 78.0, kBottom_px = 62.0, kLegend_px = 258.0;
constexpr double kMostWidth_px = 1400.0 - kLeft_px - kLegend_px;
constexpr double kMostHeight_px = 1150.0;

constexpr Color kCorridor{0.16, 0.50, 0.72, 0.10};
constexpr Color kCorridorEdge{0.16, 0.50, 0.72, 0.60};
constexpr Color kStart{0.10, 0.60, 0.25};
constexpr Color kGoal{0.80, 0.10, 0.10};
constexpr Stroke kRawPath{{0.45, 0.30, 0.60}, 1.0};
constexpr Stroke kPruned{{0.35, 0.40, 0.05}, 1.4};
constexpr Stroke kTrack{kFlown, 1.5, 6.0};
constexpr double kWaypoint_px = 3.2;

/// Room for the plot, with equal scales unless the picture would be flat as a ribbon.
struct Layout {
  View view;
  Interval u, v;
  Vec2 size_px;
  int stretch = 1;  // of v against u
};

Layout lay_out(const View& view, const Interval& u, const Interval& v) {
  Layout layout{view, u, v, {kMostWidth_px, 0.0}};
  const double ratio = v.length() / u.length();
  if (view.v == 2) {
    layout.stretch = int(std::clamp(std::ceil(300.0 / (ratio * kMostWidth_px)), 1.0, 5.0));
  }
  layout.size_px.y() = kMostWidth_px * ratio * layout.stretch;
  layout.size_px *= std::min(1.0, kMostHeight_px / layout.size_px.y());
  // Beyond some thinness the scales part, so that there is something to see.
  layout.size_px = layout.size_px.cwiseMax(240.0).array().round();
  return layout;
}

/// [m/s] the top of the scale of speeds.
double fastest_m_s(const std::vector<FollowedLeg>& followed, double v_max_m_s) {
  double fastest = v_max_m_s;
  for (const FollowedLeg& part : followed) {
    fastest = std::max(fastest, part.trajectory.peaks().speed_m_s);
  }
  return fastest;
}

class MapPicture {
 public:
  MapPicture(const Flight& flight, const Layout& layout)
      : flight_(flight),
        view_(layout.view),
        sheet_(int(kLeft_px + layout.size_px.x() + kLegend_px),
               int(kTop_px + std::max(layout.size_px.y(), 310.0) + kBottom_px)),
        plot_(sheet_, {kLeft_px, kTop_px}, layout.size_px, layout.u, layout.v),
        followed_(flight.followed()),
        kept_(flight.kept_legs()),
        fastest_m_s_(fastest_m_s(followed_, flight.limits.v_max_m_s)) {
    const ObstacleImage cells = obstacle_image(flight.obstacles, flight.grown, view_, layout.u,
                                               layout.v, guide(flight), flight.body_radius_m);
    plot_.image(cells.u, cells.v, cells.image);
    const std::string stretched =
        layout.stretch > 1 ? fmt::format(", stretched {} times", layout.stretch) : "";
    plot_.axes(fmt::format("{} [m]", "xyz"[view_.u]),
               fmt::format("{} [m]{}", "xyz"[view_.v], stretched));
    // Of plans that newer ones replaced in flight, only what was followed is drawn.
    for (const Leg* leg : kept_) corridor(*leg);
    for (const Leg* leg : kept_) {
      plot_.line(seen(leg->raw_path_map), kRawPath);
      plot_.line(seen(leg->waypoints_map), kPruned);
    }
    for (const FollowedLeg& part : followed_) trajectory(part.trajectory);
    flown();
    for (const Leg* leg : kept_) {
      for (const Vec3& p : leg->waypoints_map) plot_.dot(seen(p), kWaypoint_px, kWhite, kPruned);
    }
    ends();
    sheet_.text({kLeft_px, 26.0}, flight.title, kTitle);
    sheet_.text({kLeft_px, 52.0}, plan_summary(flight), {.size_px = 14.0});
    legend();
  }

  Status save(const std::filesystem::path& png) const { return sheet_.save(png); }

 private:
  Vec2 seen(const Vec3& p) const { return {p[view_.u], p[view_.v]}; }
  std::vector<Vec2> seen(const std::vector<Vec3>& points) const {
    std::vector<Vec2> result;
    for (const Vec3& p : points) result.push_back(seen(p));
    return result;
  }

  void corridor(const Leg& leg) {
    for (const Polytope& polytope : leg.corridor) {
      const auto corners = seen(visualization::closed_mesh(polytope).corners);
      plot_.line(visualization::convex_hull(corners), {kCorridorEdge, 1.1}, kCorridor);
    }
  }

  void trajectory(const Trajectory& trajectory) {
    const auto states =
        sampled(trajectory, int(std::clamp(trajectory.duration_s() * 50.0, 5.0, 4000.0)));
    for (std::size_t i = 0; i + 1 < states.size(); ++i) {
      // A little longer than the step: no seams between neighbours.
      const Vec2 from = seen(states[i].position);
      const Vec2 step = seen(states[i + 1].position) - from;
      const double speed = (states[i].velocity.norm() + states[i + 1].velocity.norm()) / 2.0;
      plot_.line({from, from + 1.3 * step}, {speed_color(speed / fastest_m_s_), 4.6});
    }
  }

  void flown() {
    std::vector<Vec2> track;
    for (const FlownSample& s : flight_.flown) {
      const Vec2 p = seen(s.position_map);
      const bool moved = track.empty() || (plot_.pixel(p) - plot_.pixel(track.back())).norm() > 0.7;
      if (moved) track.push_back(p);
    }
    plot_.line(track, kTrack);
  }

  void ends() {
    const auto stops = flight_.stops_map();
    const bool tour = stops.size() > 2;
    for (std::size_t i = stops.size(); i-- > 0;) {
      const std::string name = i == 0 ? "S" : tour ? fmt::to_string(i) : "G";
      plot_.dot(seen(stops[i]), 10.0, i == 0 ? kStart : kGoal, {kWhite, 2.0});
      sheet_.text(plot_.pixel(seen(stops[i])), name,
                  {.size_px = 12.0, .align = 0.5, .color = kWhite, .bold = true});
    }
  }

  void legend() {
    constexpr Color kEdge{0.6, 0.62, 0.65};
    const char* depth = view_.w == 2 ? "height" : "depth";
    const VoxelGrid* map = flight_.obstacles != nullptr ? flight_.obstacles : flight_.grown;
    if (map != nullptr) {
      plot_.explain_box(fmt::format("obstacle at the {} flown", depth), kBlocked, kEdge);
      plot_.explain_box(fmt::format("obstacle at another {}", depth), kElsewhere, kEdge);
      if (flight_.grown != nullptr) plot_.explain_box("too close for the vehicle", kGrown, kEdge);
      if (!map->known.empty()) plot_.explain_box("not measured", kUnknown, kEdge);
      plot_.leave_gap(8.0);
    }
    const auto any = [&](auto&& has) { return std::ranges::any_of(kept_, has); };
    if (any([](const Leg* leg) { return !leg->corridor.empty(); })) {
      plot_.explain_box("safe corridor", {kCorridor.r, kCorridor.g, kCorridor.b, 0.2},
                        kCorridorEdge);
    }
    if (any([](const Leg* leg) { return !leg->raw_path_map.empty(); })) {
      plot_.explain_line("voxel path", kRawPath);
    }
    if (any([](const Leg* leg) { return !leg->waypoints_map.empty(); })) {
      plot_.explain_line("pruned path", kPruned, kWaypoint_px);
    }
    if (!flight_.flown.empty()) plot_.explain_line("flown", kTrack);
    if (!followed_.empty()) {
      plot_.leave_gap(8.0);
      plot_.explain_scale("planned trajectory, speed [m/s]", fastest_m_s_, speed_color);
    }
  }

  const Flight& flight_;
  View view_;
  Sheet sheet_;
  Plot plot_;
  std::vector<FollowedLeg> followed_;
  std::vector<const Leg*> kept_;
  double fastest_m_s_;
};

}  // namespace

Status draw_top(const Flight& flight, const std::filesystem::path& png) {
  if (auto status = flight.check(); !status) return status;
  const MapWindow window = window_of(flight);
  return MapPicture(flight, lay_out({0, 1, 2}, window[0], window[1])).save(png);
}

Status draw_side(const Flight& flight, const std::filesystem::path& png) {
  if (auto status = flight.check(); !status) return status;
  const MapWindow window = window_of(flight);
  const View view = window[0].length() >= window[1].length() ? View{0, 2, 1} : View{1, 2, 0};
  return MapPicture(flight, lay_out(view, window[std::size_t(view.u)], window[2])).save(png);
}

}  // namespace goshawk::flight_report
