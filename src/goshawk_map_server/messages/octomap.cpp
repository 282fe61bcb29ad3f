#include "goshawk/map_server_messages/octomap.hpp"

#include <fmt/format.h>

#include "goshawk/map_server/octree.hpp"

namespace goshawk::map_server {

Result<RawVoxels> read_octomap(const octomap_msgs::msg::Octomap& m) {
  if (!m.binary() || m.id() != "OcTree") {
    return fail(ErrorCode::invalid_input,
                fmt::format("the message holds a {} tree of type '{}', not a binary OcTree",
                            m.binary() ? "binary" : "full", m.id()));
  }
  const std::string_view payload(reinterpret_cast<const char*>(m.data().data()), m.data().size());
  const auto tree = read_binary_payload(payload, m.resolution());
  if (!tree) return tree.error();
  return voxelize(**tree);
}

Status fill_octomap(const GridGeometry& geometry, const BitGrid& occupied, const BitGrid& known,
                    octomap_msgs::msg::Octomap& m) {
  const auto bytes = binary_payload(geometry, occupied, known);
  if (!bytes) return bytes.error();
  m.binary(true);
  m.id("OcTree");
  m.resolution(geometry.resolution_m);
  m.data().assign(bytes->begin(), bytes->end());
  return success();
}

}  // namespace goshawk::map_server
