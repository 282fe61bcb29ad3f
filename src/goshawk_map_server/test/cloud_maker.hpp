#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "goshawk/map_server/map_file.hpp"
#include "support.hpp"

/// Clouds as files, made small.
namespace goshawk::map_server::testing {

inline Result<MapSource> load(const std::string& name, const std::string& bytes,
                              const LoadOptions& options = {}) {
  return load_map_bytes(bytes, name, options);
}

inline bool is_free(const RawVoxels& voxels, const Vec3& p) {
  const auto voxel = voxels.geometry.index_of(p);
  return voxel && voxels.known.get(*voxel) && !voxels.occupied.get(*voxel);
}

inline bool is_unknown(const RawVoxels& voxels, const Vec3& p) {
  const auto voxel = voxels.geometry.index_of(p);
  return !voxel || !voxels.known.get(*voxel);
}

inline std::string pcd(const std::vector<Vec3>& points, const std::string& more = "",
                       const std::string& type = "F") {
  std::string text = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE " + type + " " + type + " " +
                     type + "\nCOUNT 1 1 1\nWIDTH " + std::to_string(points.size()) +
                     "\nHEIGHT 1\n" + more + "POINTS " + std::to_string(points.size()) +
                     "\nDATA ascii\n";
  for (const Vec3& p : points) {
    std::ostringstream line;
    line.precision(12);
    line << p.x() << " " << p.y() << " " << p.z() << "\n";
    text += line.str();
  }
  return text;
}

}  // namespace goshawk::map_server::testing
