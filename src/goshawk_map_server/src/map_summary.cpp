#include "goshawk/map_server/map_summary.hpp"

#include <fmt/format.h>

namespace goshawk::map_server {
namespace {

std::string entries(const MapSource& source, std::int64_t occupied) {
  if (source.points_read == 0) return source.format;
  std::string text = fmt::format("{}, {} {}", source.format, source.points_read,
                                 source.format == "3dmap" ? "voxels" : "points");
  if (source.triangles_read > 0) {
    text += fmt::format(" and {} triangles", source.triangles_read);
  } else if (occupied > 0 && source.format != "3dmap") {
    const std::int64_t used = source.points_read - source.points_not_finite - source.points_outside;
    text += fmt::format(", {:.1f} an occupied voxel", double(used) / double(occupied));
  }
  return text;
}

std::string left_out(const MapSource& source) {
  std::string text;
  const auto add = [&](std::int64_t count, const char* what) {
    if (count > 0) text += fmt::format(", {} {}", count, what);
  };
  add(source.points_not_finite, "not finite");
  add(source.points_outside, "outside the box");
  add(source.outliers, "outliers left out");
  return text;
}

}  // namespace

std::string summarise(const RawVoxels& raw) {
  const GridGeometry& g = raw.geometry;
  const std::int64_t occupied = raw.occupied.count(), known = raw.known.count();
  const auto percent = [&](std::int64_t count) {
    return 100.0 * double(count) / double(raw.occupied.voxels());
  };
  const Vec3 span = g.upper_corner_map() - g.origin_map;
  return fmt::format(
      "{:.6g} x {:.6g} x {:.6g} m from {} to {}, {:.1f} % occupied, {:.1f} % free, {:.1f} % "
      "unknown",
      span.x(), span.y(), span.z(), to_text(g.origin_map), to_text(g.upper_corner_map()),
      percent(occupied), percent(known - occupied), percent(raw.occupied.voxels() - known));
}

std::string summarise(const MapSource& source, const RawVoxels& raw) {
  return fmt::format("{}{}: {}", entries(source, raw.occupied.count()), left_out(source),
                     summarise(raw));
}

}  // namespace goshawk::map_server
