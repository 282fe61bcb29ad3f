// The picture of a map that grows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "goshawk/flight_report/growth.hpp"
#include "obstacle_image.hpp"
#include "plot.hpp"
#include "style.hpp"

namespace goshawk::flight_report {
namespace {

constexpr std::size_t kMostPanels = 12;
constexpr double kPanelWidth_px = 400.0, kBetween_px = 76.0, kLegendWidth_px = 210.0,
                 kHead_px = 50.0;
constexpr double kHalfHeight_m = 0.5;  // about the heights flown

constexpr Color kUnseen{0.74, 0.74, 0.72};
constexpr Color kLearnt{0.72, 0.86, 0.96};
constexpr Color kLearntBlocked{0.84, 0.37, 0.0};
constexpr Stroke kWindow{{0.35, 0.37, 0.40}, 1.2, 5.0};
constexpr Stroke kWay{kFlown, 1.6};

std::uint32_t pixel_of(const Color& c) {
  const auto byte = [](double x) { return std::uint32_t(std::lround(255.0 * x)); };
  return byte(c.r) << 16 | byte(c.g) << 8 | byte(c.b);
}

/// What a column of voxels is at the heights flown nearby.
enum class Column { unknown, free, blocked };

/// Where the vehicle flew, as far as it matters for heights; of a map without a track nothing.
std::vector<Vec3> guide_of(const MapMoment& last) {
  constexpr std::size_t kMostPlaces = 100;
  std::vector<Vec3> guide;
  const std::size_t step = last.track_map.size() / kMostPlaces + 1;
  for (std::size_t i = 0; i < last.track_map.size(); i += step) guide.push_back(last.track_map[i]);
  return guide;
}

/// A grid from above.
class FromAbove {
 public:
  FromAbove(const VoxelGrid& grid, const std::vector<Vec3>& guide)
      : grid_(grid), obstacles_(grid.raw.empty() ? grid.grown : grid.raw), guide_(guide) {}

  /// At a point of the map; unknown outside of the grid.
  Column at(double x_m, double y_m) const {
    const GridGeometry& g = grid_.geometry;
    const int x = int(std::floor((x_m - g.origin_map.x()) / g.resolution_m));
    const int y = int(std::floor((y_m - g.origin_map.y()) / g.resolution_m));
    if (x < 0 || y < 0 || x >= g.size.x || y >= g.size.y) return Column::unknown;
    const auto [first, last] = layers_at(x_m, y_m);
    Column column = Column::unknown;
    for (int z = first; z <= last; ++z) {
      const Index3 i{x, y, z};
      if (!grid_.is_known(i)) continue;
      if (obstacles_.test(i)) return Column::blocked;
      column = Column::free;
    }
    return column;
  }

 private:
  /// About the height of the nearest place that was flown through.
  std::pair<int, int> layers_at(double x_m, double y_m) const {
    const GridGeometry& g = grid_.geometry;
    if (guide_.empty()) return {0, g.size.z - 1};
    const Vec2 here(x_m, y_m);
    const double height_m = std::ranges::min_element(guide_, {}, [&](const Vec3& p) {
                              return (p.head<2>() - here).squaredNorm();
                            })->z();
    const auto layer = [&](double z_m) {
      const double at = std::floor((z_m - g.origin_map.z()) / g.resolution_m);
      return int(std::clamp(at, 0.0, double(g.size.z - 1)));
    };
    return {layer(height_m - kHalfHeight_m), layer(height_m + kHalfHeight_m)};
  }

  const VoxelGrid& grid_;
  const BitGrid& obstacles_;
  const std::vector<Vec3>& guide_;
};

Color color_of(Column now, Column before) {
  switch (now) {
    case Column::unknown:
      return kUnseen;
    case Column::free:
      return before == Column::free ? kWhite : kLearnt;
    case Column::blocked:
      break;
  }
  return before == Column::blocked ? kBlocked : kLearntBlocked;
}

Image image_of(const MapMoment& now, const MapMoment* before, const std::vector<Vec3>& guide) {
  const GridGeometry& g = now.grid.geometry;
  const FromAbove seen(now.grid, guide);
  std::optional<FromAbove> old;
  if (before != nullptr) old.emplace(before->grid, guide);
  Image image{g.size.x, {}};
  image.pixels.reserve(std::size_t(g.size.x) * std::size_t(g.size.y));
  for (int y = g.size.y - 1; y >= 0; --y) {
    for (int x = 0; x < g.size.x; ++x) {
      const Vec3 p = g.origin_map + g.resolution_m * Vec3(x + 0.5, y + 0.5, 0.0);
      const Column was = old ? old->at(p.x(), p.y()) : Column::unknown;
      image.pixels.push_back(pixel_of(color_of(seen.at(p.x(), p.y()), was)));
    }
  }
  return image;
}

Interval along(const GridGeometry& g, int axis) {
  return {g.origin_map[axis], g.upper_corner_map()[axis]};
}

Status check(std::span<const MapMoment> moments) {
  if (moments.empty() || moments.size() > kMostPanels) {
    return fail(ErrorCode::invalid_input,
                fmt::format("a picture of a map that grows shows 1 to {} moments, not {}",
                            kMostPanels, moments.size()));
  }
  for (const MapMoment& m : moments) {
    if (!std::isfinite(m.t_s) || !std::ranges::all_of(m.track_map, is_finite) ||
        m.grid.geometry.size.x < 1) {
      return fail(ErrorCode::invalid_input, "a moment needs a map, and finite times and places");
    }
  }
  return success();
}

void draw_panel(Plot& plot, const MapMoment& now, const MapMoment* before,
                const std::vector<Vec3>& guide) {
  const Interval u = along(now.grid.geometry, 0), v = along(now.grid.geometry, 1);
  plot.line({{plot.u().lo, plot.v().lo},
             {plot.u().hi, plot.v().lo},
             {plot.u().hi, plot.v().hi},
             {plot.u().lo, plot.v().hi}},
            {kClear, 0.0}, kUnseen);
  plot.image(u, v, image_of(now, before, guide));
  plot.line({{u.lo, v.lo}, {u.hi, v.lo}, {u.hi, v.hi}, {u.lo, v.hi}, {u.lo, v.lo}}, kWindow);
  std::vector<Vec2> track;
  for (const Vec3& p : now.track_map) track.push_back({p.x(), p.y()});
  plot.line(track, kWay);
  if (!track.empty()) plot.dot(track.back(), 5.0, kFlown, {kWhite, 1.5});
}

void explain(Plot& plot, const MapMoment& last) {
  constexpr Color kEdge{0.6, 0.62, 0.65};
  plot.explain_box("unknown", kUnseen, kEdge);
  plot.explain_box("free", kWhite, kEdge);
  const bool raw = !last.grid.raw.empty();
  plot.explain_box(raw ? "obstacle" : "blocked for its centre", kBlocked, kEdge);
  plot.explain_box("free since the panel before", kLearnt, kEdge);
  plot.explain_box(raw ? "obstacle since then" : "blocked since then", kLearntBlocked, kEdge);
  plot.explain_line("window of the map", kWindow);
  plot.explain_line("flown", kWay);
  plot.note(last.track_map.empty()
                ? "at any height"
                : fmt::format("within {:g} m of the height flown nearby", kHalfHeight_m));
}

}  // namespace

Status draw_growth(std::span<const MapMoment> moments, const std::filesystem::path& png) {
  if (auto status = check(moments); !status) return status;
  Interval u = along(moments.front().grid.geometry, 0), v = along(moments.front().grid.geometry, 1);
  for (const MapMoment& m : moments) {
    for (const auto& [all, axis] : {std::pair{&u, 0}, {&v, 1}}) {
      all->include(along(m.grid.geometry, axis).lo);
      all->include(along(m.grid.geometry, axis).hi);
    }
  }
  const std::vector<Vec3> guide = guide_of(moments.back());
  const int panels = int(moments.size());
  const int columns = panels <= 2 ? panels : panels <= 4 ? 2 : 3;
  const int rows = (panels + columns - 1) / columns;
  const Vec2 size(kPanelWidth_px,
                  std::clamp(kPanelWidth_px * v.length() / u.length(), 120.0, 700.0));
  Sheet sheet(int(kBetween_px + columns * (size.x() + kBetween_px) + kLegendWidth_px),
              int(rows * (size.y() + kHead_px + kBetween_px)));
  for (int k = 0; k < panels; ++k) {
    const MapMoment& now = moments[std::size_t(k)];
    const Vec2 corner(kBetween_px + (k % columns) * (size.x() + kBetween_px),
                      kHead_px + (k / columns) * (size.y() + kHead_px + kBetween_px));
    Plot plot(sheet, corner, size, u, v);
    draw_panel(plot, now, k > 0 ? &moments[std::size_t(k) - 1] : nullptr, guide);
    plot.axes("x [m]", "y [m]");
    sheet.text(corner - Vec2(0.0, 20.0), fmt::format("after {:.1f} s", now.t_s),
               {.size_px = 15.0, .bold = true});
    if (k == columns - 1) explain(plot, moments.back());
  }
  return sheet.save(png);
}

}  // namespace goshawk::flight_report
