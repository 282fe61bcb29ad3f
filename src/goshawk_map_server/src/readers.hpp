#pragma once

#include <string_view>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"
#include "goshawk/map_server/octree.hpp"

namespace goshawk::map_server {

/// The readers behind load_map. Each gets the bytes of a whole file, and trusts none of them.

Result<OcTreePtr> read_bt(std::string_view bytes);
Result<OcTreePtr> read_ot(std::string_view bytes);

/// The points that a cloud file holds, not finite ones included.
using Points = std::vector<Vec3>;
Result<Points> read_pcd(std::string_view bytes);
Result<Points> read_ply(std::string_view bytes);

struct WarframeMap {
  Index3 size;
  std::vector<Index3> occupied;  // all inside
};
Result<WarframeMap> read_warframe(std::string_view bytes);

inline Error malformed(std::string what) {
  return fail(ErrorCode::map_malformed, std::move(what));
}

}  // namespace goshawk::map_server
