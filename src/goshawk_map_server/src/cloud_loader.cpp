#include "cloud_loader.hpp"

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>

#include "cloud_report.hpp"
#include "mesh_raster.hpp"
#include "outliers.hpp"
#include "scan.hpp"

namespace goshawk::map_server {
namespace {

Status check(const LoadOptions& options) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0.0; };
  if (!positive(options.resolution_m) || !positive(options.max_range_m) ||
      !positive(options.scale) || !is_finite(options.origin_file) ||
      !is_finite(options.turn_rad) ||
      !is_finite(options.sensor_origin_map.value_or(Vec3::Zero()))) {
    return fail(ErrorCode::invalid_parameter,
                "a cloud's resolution, range and scale must be finite and above zero, its origin, "
                "its turn and its sensor's origin finite");
  }
  return success();
}

// Whether the points are relative to the viewpoint.
Result<bool> is_in_sensor_frame(const Viewpoint& viewpoint, const LoadOptions& options) {
  if (options.frame != CloudFrame::automatic) return options.frame == CloudFrame::sensor;
  if (viewpoint.orientation.vec().norm() > 1e-9) return true;
  if (options.cloud == CloudMeaning::scan) return false;
  return fail(ErrorCode::invalid_parameter,
              fmt::format("its VIEWPOINT is {}: set cloud_frame to sensor if the points are "
                          "relative to that, or to map if they are in the map's frame already",
                          to_text(viewpoint.position)));
}

// Exactly itself for a zero, so that no coordinate is rounded for nothing.
Eigen::Matrix3d turn_of(const Vec3& rad) {
  if (rad.isZero(0.0)) return Eigen::Matrix3d::Identity();
  return (Eigen::AngleAxisd(rad.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rad.y(), Vec3::UnitY()) *
          Eigen::AngleAxisd(rad.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

// Into the map's frame. @return where the sensor was
Result<Vec3> place(Cloud& cloud, const LoadOptions& options, MapSource& source) {
  const Eigen::Matrix3d turn = turn_of(options.turn_rad);
  const auto to_map = [&](const Vec3& p) -> Vec3 {
    return turn * (options.scale * p - options.origin_file);
  };
  const Viewpoint viewpoint = cloud.viewpoint.value_or(Viewpoint{});
  if (cloud.viewpoint) {
    const auto relative = is_in_sensor_frame(viewpoint, options);
    if (!relative) return relative.error();
    if (*relative) {
      for (Vec3& p : cloud.points) p = viewpoint.orientation * p + viewpoint.position;
      source.notes.push_back("the points were moved and turned by the file's VIEWPOINT");
    }
  }
  for (Vec3& p : cloud.points) p = to_map(p);
  if (options.sensor_origin_map) return *options.sensor_origin_map;
  if (!cloud.viewpoint) return Vec3::Zero().eval();
  const Vec3 sensor_map = to_map(viewpoint.position);
  if (options.cloud == CloudMeaning::scan) {
    source.notes.push_back(
        fmt::format("rays begin at the file's VIEWPOINT, {} m", to_text(sensor_map)));
  }
  return sensor_map;
}

// A triangle that is not finite would be a wall that is missing.
Status check_triangles(const Cloud& cloud) {
  for (const auto& triangle : cloud.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (is_finite(cloud.points[corner])) continue;
      return malformed(fmt::format("a face has the vertex {}, which is not finite: repair the mesh",
                                   corner));
    }
  }
  return success();
}

// Drops what is not finite or outside the box.
Points usable(const Points& points, const LoadOptions& options, MapSource& source) {
  Points kept;
  kept.reserve(points.size());
  for (const Vec3& p : points) {
    if (!is_finite(p)) {
      ++source.points_not_finite;
    } else if (options.box && !options.box->holds(p)) {
      ++source.points_outside;
    } else {
      kept.push_back(p);
    }
  }
  return kept;
}

Box box_around(const Points& points, double resolution_m) {
  Box box = box_of(points);
  // A point on a face belongs to the upper voxel: the box must reach beyond it.
  box.upper_map += Vec3::Constant(0.01 * resolution_m);
  return box;
}

Error nothing_left(const MapSource& source) {
  if (source.points_read == 0) return fail(ErrorCode::map_empty, "it holds no points");
  return fail(ErrorCode::map_empty,
              fmt::format("none of its {} points can be used: {} are not finite, {} lie outside "
                          "the box",
                          source.points_read, source.points_not_finite, source.points_outside));
}

// Points far from all others, which would make the map large.
void drop_far(Points& points, const LoadOptions& options, MapSource& source) {
  const auto far = find_outliers(points, options.resolution_m);
  if (!far) return;
  const Box& rest = far->rest;  // closed: its faces go through points
  source.outliers += std::int64_t(std::erase_if(points, [&](const Vec3& p) {
    return (p.array() < rest.lower_map.array()).any() || (p.array() > rest.upper_map.array()).any();
  }));
}

// The voxels of the points and of the faces between them.
BitGrid fill(const Cloud& cloud, const Points& points, const GridGeometry& geometry) {
  BitGrid occupied(geometry.size, true);
  for (const Vec3& p : points) {
    if (const auto voxel = geometry.index_of(p)) occupied.set(*voxel, true);
  }
  for (const auto& triangle : cloud.triangles) {
    const auto corner = [&](std::size_t k) -> Vec3 {
      return geometry.to_grid(cloud.points[triangle[k]]);
    };
    rasterise({corner(0), corner(1), corner(2)}, occupied);
  }
  return occupied;
}

Status load_voxels(const Cloud& cloud, const LoadOptions& options, MapSource& source) {
  Points points = usable(cloud.points, options, source);
  const bool drop = options.drop_outliers && cloud.triangles.empty();
  if (drop) drop_far(points, options, source);
  // The faces of a mesh may pass through a box that holds none of its corners.
  if (points.empty() && (cloud.triangles.empty() || !options.box)) return nothing_left(source);
  const Box box = options.box ? *options.box : box_around(points, options.resolution_m);
  const auto geometry = raster_of(box, options.resolution_m, options.max_voxels);
  if (!geometry) {
    if (options.box) return geometry.error();
    return explain(geometry.error(), points, options);
  }
  BitGrid occupied = fill(cloud, points, *geometry);
  note_oddities(cloud, points, *geometry, occupied, source.notes);
  if (drop) source.outliers += drop_lonely(occupied);
  if (occupied.count() == 0) return nothing_left(source);
  const bool all = options.cloud == CloudMeaning::map;
  BitGrid known(geometry->size, false, all);
  if (!all) {
    auto same = BitGrid::from_words(geometry->size, false, occupied.to_words());
    if (!same) return same.error();
    known = *std::move(same);
  }
  source.voxels = RawVoxels{*geometry, std::move(occupied), std::move(known)};
  return success();
}

Status load_scan(const Cloud& cloud, const Vec3& sensor_map, const LoadOptions& options,
                 MapSource& source) {
  if (!cloud.triangles.empty()) {
    return fail(ErrorCode::invalid_parameter,
                "a mesh is not a scan: use cloud_meaning map or points");
  }
  if (options.drop_outliers) {
    return fail(ErrorCode::invalid_parameter,
                "outliers of a scan are not dropped: use cloud_meaning map or points");
  }
  const auto bad = [](const Vec3& p) { return !is_finite(p); };
  source.points_not_finite = std::ranges::count_if(cloud.points, bad);
  if (source.points_not_finite == source.points_read) return nothing_left(source);
  auto tree = std::make_shared<octomap::OcTree>(options.resolution_m);
  const auto inserted = insert_scan(*tree, cloud.points, sensor_map, options.max_range_m,
                                    options.box ? &*options.box : nullptr);
  if (!inserted) return inserted.error();
  source.points_outside = inserted->cut;
  if (tree->size() == 0) return fail(ErrorCode::map_empty, "the scan reaches no voxel");
  source.tree = std::move(tree);
  return success();
}

}  // namespace

Status load_cloud(Cloud cloud, const LoadOptions& options, MapSource& source) {
  if (auto status = check(options); !status) return status;
  if (auto status = check_triangles(cloud); !status) return status;
  source.points_read = std::int64_t(cloud.points.size());
  source.triangles_read = std::int64_t(cloud.triangles.size());
  note_coarse_floats(cloud, options, source.notes);
  const auto sensor_map = place(cloud, options, source);
  if (!sensor_map) return sensor_map.error();
  if (options.cloud == CloudMeaning::scan) return load_scan(cloud, *sensor_map, options, source);
  return load_voxels(cloud, options, source);
}

}  // namespace goshawk::map_server
