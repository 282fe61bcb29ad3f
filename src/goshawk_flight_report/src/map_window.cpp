#include "map_window.hpp"

#include <algorithm>

#include "style.hpp"

namespace goshawk::flight_report {

namespace {

constexpr double kWholeHeight_m = 6.0;  // maps up to this high are shown from floor to ceiling
constexpr std::size_t kGuidePoints = 150;

void append(std::vector<Vec3>& points, const Trajectory& trajectory) {
  for (const FlatState& s : sampled(trajectory, 200)) points.push_back(s.position);
}

void append_polyline(std::vector<Vec3>& points, const std::vector<Vec3>& corners) {
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    for (int k = 0; k < 10; ++k) {
      points.push_back(corners[i] + (corners[i + 1] - corners[i]) * k / 10);
    }
  }
  if (!corners.empty()) points.push_back(corners.back());
}

std::vector<Vec3> places_of(const Flight& flight) {
  std::vector<Vec3> points;
  for (const FlownSample& s : flight.flown) points.push_back(s.position_map);
  for (const Leg& leg : flight.legs) {
    points.insert(points.end(), leg.raw_path_map.begin(), leg.raw_path_map.end());
    points.insert(points.end(), leg.waypoints_map.begin(), leg.waypoints_map.end());
    append(points, leg.trajectory);
  }
  points.insert(points.end(), flight.goals_map.begin(), flight.goals_map.end());
  return points;
}

}  // namespace

MapWindow window_of(const Flight& flight) {
  const VoxelGrid* grid = flight.obstacles != nullptr ? flight.obstacles : flight.grown;
  MapWindow map;
  map.fill({-1.0, 1.0});
  for (int axis = 0; axis < 3 && grid != nullptr; ++axis) {
    map[std::size_t(axis)] = {grid->geometry.origin_map[axis],
                              grid->geometry.upper_corner_map()[axis]};
  }
  const auto places = places_of(flight);
  if (places.empty()) return map;
  Vec3 lower = places.front(), upper = places.front();
  for (const Vec3& p : places) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const double extent = (upper - lower).maxCoeff();
  const double edge_m = 2.0 * flight.body_radius_m;
  MapWindow window;
  for (int axis = 0; axis < 3; ++axis) {
    const bool vertical = axis == 2;
    const Interval whole = grid != nullptr ? map[std::size_t(axis)] : Interval{-1e7, 1e7};
    const double room_m =
        vertical ? std::clamp(0.1 * extent, 0.5, 1.5) : std::max(1.5, 0.2 * extent);
    Interval& shown = window[std::size_t(axis)];
    if (vertical && whole.length() <= kWholeHeight_m) {
      shown = whole;
      shown.include(lower[axis]);
      shown.include(upper[axis]);
    } else {
      shown = {std::max(whole.lo, lower[axis] - room_m), std::min(whole.hi, upper[axis] + room_m)};
      shown.include(lower[axis] - edge_m);
      shown.include(upper[axis] + edge_m);
    }
  }
  return window;
}

std::vector<Vec3> guide(const Flight& flight) {
  std::vector<Vec3> way;
  for (const FlownSample& s : flight.flown) way.push_back(s.position_map);
  if (way.empty()) {
    for (const Leg& leg : flight.legs) {
      append(way, leg.trajectory);
      if (!leg.trajectory.pieces.empty()) continue;
      append_polyline(way, leg.waypoints_map.empty() ? leg.raw_path_map : leg.waypoints_map);
    }
  }
  std::vector<Vec3> guide;
  const std::size_t step = std::max<std::size_t>(1, (way.size() + kGuidePoints - 1) / kGuidePoints);
  for (std::size_t i = 0; i < way.size(); i += step) guide.push_back(way[i]);
  return guide;
}

}  // namespace goshawk::flight_report
