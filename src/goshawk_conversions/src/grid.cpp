#include "goshawk/conversions/grid.hpp"

#include <limits>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::conversions {

Result<VoxelGrid> from_msg(const goshawk_msgs::msg::VoxelGrid& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a voxel grid"); !status) {
    return status.error();
  }
  constexpr auto kMax = std::uint32_t(std::numeric_limits<int>::max());
  if (m.size_x() > kMax || m.size_y() > kMax || m.size_z() > kMax) {
    return fail(ErrorCode::map_too_large, "a voxel grid has a dimension beyond 2^31 voxels");
  }
  VoxelGrid grid;
  grid.geometry.origin_map = from_msg(m.origin());
  grid.geometry.resolution_m = m.resolution();
  grid.geometry.size = {int(m.size_x()), int(m.size_y()), int(m.size_z())};
  auto occupied = BitGrid::from_words(grid.geometry.size, true, m.occupied());
  if (!occupied) return occupied.error();
  grid.occupied = *std::move(occupied);
  if (!m.known().empty()) {
    auto known = BitGrid::from_words(grid.geometry.size, false, m.known());
    if (!known) return known.error();
    grid.known = *std::move(known);
  }
  grid.version = m.version();
  grid.inflation_m = m.inflation();
  grid.unknown_is_occupied = m.unknown_is_occupied();
  if (auto status = grid.check(); !status) return status.error();
  return grid;
}

void fill_msg(const VoxelGrid& grid, goshawk_msgs::msg::VoxelGrid& m) {
  m.version(grid.version);
  m.origin(to_point(grid.geometry.origin_map));
  m.resolution(grid.geometry.resolution_m);
  m.size_x(std::uint32_t(grid.geometry.size.x));
  m.size_y(std::uint32_t(grid.geometry.size.y));
  m.size_z(std::uint32_t(grid.geometry.size.z));
  m.inflation(grid.inflation_m);
  m.unknown_is_occupied(grid.unknown_is_occupied);
  m.occupied().assign(grid.occupied.words().begin(), grid.occupied.words().end());
  m.known().assign(grid.known.words().begin(), grid.known.words().end());
}

}  // namespace goshawk::conversions
