#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"
#include "goshawk/map_server/octree.hpp"

namespace goshawk::map_server {

/// The readers behind load_map. Each gets the bytes of a whole file, and trusts none of them.

Result<OcTreePtr> read_bt(std::string_view bytes);
Result<OcTreePtr> read_ot(std::string_view bytes);

using Points = std::vector<Vec3>;

/// Where a cloud was taken from, in the file's units.
struct Viewpoint {
  Vec3 position = Vec3::Zero();
  Eigen::Quaternion<double, Eigen::DontAlign> orientation =
      Eigen::Quaternion<double, Eigen::DontAlign>::Identity();  // unit length
};

/// What a cloud file holds: points, not finite ones included, and triangles between them.
struct Cloud {
  Points points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // each below points.size()
  std::optional<Viewpoint> viewpoint;                   // only if it is not the origin
  bool single_precision = false;                        // coordinates are 32-bit floats
};
Result<Cloud> read_pcd(std::string_view bytes);
/// Faces, strips and edges become triangles.
Result<Cloud> read_ply(std::string_view bytes);
Result<Cloud> read_stl(std::string_view bytes);
/// Faces and lines become triangles.
Result<Cloud> read_obj(std::string_view bytes);

struct WarframeMap {
  Index3 size;
  std::vector<Index3> occupied;  // all inside
};
Result<WarframeMap> read_warframe(std::string_view bytes);

inline Error malformed(std::string what) {
  return fail(ErrorCode::map_malformed, std::move(what));
}

}  // namespace goshawk::map_server
