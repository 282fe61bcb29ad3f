#include "cloud_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace goshawk::map_server {
namespace {

constexpr std::size_t kFewest = 100;     // points from which on "most of them" means something
constexpr double kFewShare = 0.005;      // of all points, to each side of each axis
constexpr double kLeastGap_m = 20.0;     // between a point and all others
constexpr double kMuchLarger = 4.0;      // a box, for the sake of a few points
constexpr double kLongest_m = 1000.0;    // a map that is longer in two directions is suspicious
constexpr double kReach_voxels = 32768.0;    // [voxels] that an OctoMap reaches from the origin

Box box_of(const Points& points) {
  Box box{points.front(), points.front()};
  for (const Vec3& p : points) {
    box.lower_map = box.lower_map.cwiseMin(p);
    box.upper_map = box.upper_map.cwiseMax(p);
  }
  return box;
}

// Cubic metres; a flat box counts as one voxel thick.
double volume(const Box& box, double resolution_m) {
  return (box.upper_map - box.lower_map).cwiseMax(resolution_m).prod();
}

// A few points that lie far from all others, and the box of those.
struct Outliers {
  std::int64_t count = 0;
  Vec3 farthest_map = Vec3::Zero();
  Box rest;
};

// What most points span along each axis.
Box usual_box(const Points& points) {
  Box box;
  std::vector<double> values(points.size());
  const auto few = std::size_t(kFewShare * double(points.size()));
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i][axis];
    const auto nth = [&](std::size_t n) {
      std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(n), values.end());
      return values[n];
    };
    box.lower_map[axis] = nth(few);
    box.upper_map[axis] = nth(points.size() - 1 - few);
  }
  return box;
}

double distance(const Box& box, const Vec3& p) {
  return (p - p.cwiseMax(box.lower_map).cwiseMin(box.upper_map)).norm();
}

// Outwards from most points: the first gap that is wider than all before it is long, along
// whatever axis (a floor with a few points above it has no outliers), parts the others from them.
std::optional<Outliers> find_outliers(const Points& points, double resolution_m) {
  if (points.size() < kFewest) return {};
  const Box usual = usual_box(points);
  std::vector<std::pair<double, std::size_t>> others;  // distance [m], number
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const double d = distance(usual, points[i]); d > 0.0) others.emplace_back(d, i);
  }
  std::ranges::sort(others);
  Outliers found;
  found.rest = usual;
  std::size_t near = 0;
  for (; near < others.size(); ++near) {
    const Vec3& p = points[others[near].second];
    const double length_m = (found.rest.upper_map - found.rest.lower_map).maxCoeff();
    if (distance(found.rest, p) > std::max(kLeastGap_m, length_m)) break;
    found.rest.lower_map = found.rest.lower_map.cwiseMin(p);
    found.rest.upper_map = found.rest.upper_map.cwiseMax(p);
  }
  if (near == others.size()) return {};
  found.count = std::int64_t(others.size() - near);
  found.farthest_map = points[others.back().second];
  const double whole = volume(box_of(points), resolution_m);
  if (whole < kMuchLarger * volume(found.rest, resolution_m)) return {};
  return found;
}

std::string sentence(const Outliers& outliers, std::size_t points) {
  return fmt::format(
      "{} of {} points lie far from all others, the farthest at {} m: the others span {} to {} m; "
      "set use_box and a box around those to leave it out",
      outliers.count, points, to_text(outliers.farthest_map), to_text(outliers.rest.lower_map),
      to_text(outliers.rest.upper_map));
}

// Coordinates of a map projection: all far from the origin, but not from each other.
std::optional<std::string> far_from_origin(const Box& box, double resolution_m) {
  const double reach_m = kReach_voxels * resolution_m;
  if ((box.upper_map - box.lower_map).maxCoeff() > reach_m) return {};
  std::string settings;
  for (int axis = 0; axis < 3; ++axis) {
    if (box.upper_map[axis] < reach_m && box.lower_map[axis] > -reach_m) continue;
    settings += fmt::format("{}cloud_origin_{}_m to {:.0f}", settings.empty() ? "" : ", ",
                            "xyz"[axis], std::floor(box.lower_map[axis]));
  }
  if (settings.empty()) return {};
  return fmt::format(
      "its points lie around {} m, and a map reaches {:.0f} m from its origin at most: set {}, "
      "which is subtracted from every point",
      to_text(Vec3(0.5 * (box.lower_map + box.upper_map))), reach_m, settings);
}

std::optional<std::string> other_unit(const Box& box) {
  const Vec3 span = box.upper_map - box.lower_map;
  if ((span.array() > kLongest_m).count() < 2) return {};
  return fmt::format(
      "it spans {:.0f} x {:.0f} x {:.0f} m: if its unit is the millimetre, set cloud_scale to 0.001",
      span.x(), span.y(), span.z());
}

}  // namespace

Error explain(Error error, const Points& points, const LoadOptions& options) {
  const Box box = box_of(points);
  if (const auto outliers = find_outliers(points, options.resolution_m)) {
    error.message = sentence(*outliers, points.size()) + " (" + error.message + ")";
    const auto far = far_from_origin(outliers->rest, options.resolution_m);
    if (far) error.message += "; " + *far;
  } else if (const auto far = far_from_origin(box, options.resolution_m)) {
    error.message = *far;
  } else if (const auto unit = other_unit(box)) {
    error.message += "; " + *unit;
  }
  return error;
}

void note_oddities(const Cloud& cloud, const Points& points, const LoadOptions& options,
                   std::vector<std::string>& notes) {
  if (points.empty()) return;
  // The corners of a mesh may lie far apart.
  if (cloud.triangles.empty()) {
    if (const auto outliers = find_outliers(points, options.resolution_m)) {
      notes.push_back(sentence(*outliers, points.size()));
    }
  }
  if (auto unit = other_unit(box_of(points))) notes.push_back(*unit);
}

void note_coarse_floats(const Cloud& cloud, const LoadOptions& options,
                        std::vector<std::string>& notes) {
  if (!cloud.single_precision) return;
  double largest = 0.0;
  for (const Vec3& p : cloud.points) {
    if (is_finite(p)) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  if (largest > double(std::numeric_limits<float>::max())) return;
  const auto value = float(largest);
  const double step_m =
      options.scale *
      (double(std::nextafter(value, std::numeric_limits<float>::infinity())) - double(value));
  if (step_m < 0.25 * options.resolution_m) return;
  notes.push_back(fmt::format(
      "its coordinates, up to {:.0f}, are 32-bit floats in steps of {:g} m there: obstacles may be "
      "off by as much; export doubles, or coordinates near zero",
      largest, step_m));
}

}  // namespace goshawk::map_server
