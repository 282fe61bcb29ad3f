#include "cloud_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "outliers.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kShortest_m = 1.0;     // a map that is smaller is suspicious
constexpr std::size_t kFewestForHoles = 100;  // points
constexpr double kLongest_m = 1000.0;    // a map that is longer in two directions is suspicious
constexpr double kReach_voxels = 32768.0;    // [voxels] that an OctoMap reaches from the origin

std::string sentence(const Outliers& outliers, std::size_t points) {
  return fmt::format(
      "{} of {} points lie far from all others, the farthest at {} m: the others span {} to {} m; "
      "set use_box and a box around those, or convert the map with goshawk world --convert "
      "--drop-outliers, to leave it out",
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
      "it spans {:.0f} x {:.0f} x {:.0f} m: if its unit is the millimetre, set cloud_scale to 0.001 "
      "(centimetre: 0.01)",
      span.x(), span.y(), span.z());
}

// A map that is smaller than a vehicle: of another unit, as a rule.
std::optional<std::string> too_small(const Box& box, double resolution_m) {
  const Vec3 span = box.upper_map - box.lower_map;
  if (span.maxCoeff() >= kShortest_m) return {};
  return fmt::format(
      "it spans {:.3g} x {:.3g} x {:.3g} m only, in voxels of {:g} m: if its unit is not the metre, "
      "set cloud_scale to the length of its unit in metres",
      span.x(), span.y(), span.z(), resolution_m);
}

// Walls of points that are farther apart than a voxel have holes. Asked of some of the points.
std::optional<std::string> full_of_holes(const Points& points, const GridGeometry& geometry,
                                         const BitGrid& occupied) {
  constexpr std::size_t kEnough = 20'000;
  if (points.size() < kFewestForHoles) return {};
  const std::size_t step = points.size() / kEnough + 1;
  std::int64_t asked = 0, alone = 0;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const auto voxel = geometry.index_of(points[i]);
    if (!voxel) continue;
    ++asked;
    alone += is_alone(occupied, *voxel);
  }
  if (2 * alone <= asked) return {};
  return fmt::format(
      "{:.0f} % of its points lie in voxels that touch no other: the points are farther apart than "
      "{:g} m, so that walls have holes; use a coarser resolution, or a denser cloud",
      100.0 * double(alone) / double(asked), geometry.resolution_m);
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

void note_oddities(const Cloud& cloud, const Points& points, const GridGeometry& geometry,
                   const BitGrid& occupied, std::vector<std::string>& notes) {
  if (points.empty()) return;
  const double resolution_m = geometry.resolution_m;
  // The corners of a mesh may lie far apart.
  if (cloud.triangles.empty()) {
    if (const auto outliers = find_outliers(points, resolution_m)) {
      notes.push_back(sentence(*outliers, points.size()));
    }
    if (auto holes = full_of_holes(points, geometry, occupied)) notes.push_back(*holes);
  }
  const Box box = box_of(points);
  if (auto unit = other_unit(box)) notes.push_back(*unit);
  if (auto small = too_small(box, resolution_m)) notes.push_back(*small);
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
