#include "goshawk/conversions/grid.hpp"

#include <algorithm>
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

Result<GridUpdate> from_msg(const goshawk_msgs::msg::VoxelGridUpdate& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a voxel grid update"); !status) {
    return status.error();
  }
  GridUpdate update{m.from_version(), m.to_version(), {}};
  update.bricks.reserve(m.bricks().size());
  for (const auto& b : m.bricks()) {
    if (b.occupied().size() != Brick::kWords || b.known().size() != Brick::kWords) {
      return fail(ErrorCode::invalid_input,
                  "a brick of an update has " + std::to_string(b.occupied().size()) + " and " +
                      std::to_string(b.known().size()) + " words: 64 and 64 are needed");
    }
    constexpr std::uint32_t kMax = 1U << 28;  // far beyond any grid; apply() has the exact check
    Brick brick;
    brick.index = {int(std::min(b.word_x(), kMax)), int(std::min(b.brick_y(), kMax)),
                   int(std::min(b.brick_z(), kMax))};
    std::ranges::copy(b.occupied(), brick.occupied.begin());
    std::ranges::copy(b.known(), brick.known.begin());
    update.bricks.push_back(brick);
  }
  return update;
}

void fill_msg(const GridUpdate& update, goshawk_msgs::msg::VoxelGridUpdate& m) {
  m.from_version(update.from_version);
  m.to_version(update.to_version);
  m.bricks().resize(update.bricks.size());
  for (std::size_t k = 0; k < update.bricks.size(); ++k) {
    const Brick& brick = update.bricks[k];
    auto& b = m.bricks()[k];
    b.word_x(std::uint32_t(brick.index.x));
    b.brick_y(std::uint32_t(brick.index.y));
    b.brick_z(std::uint32_t(brick.index.z));
    b.occupied().assign(brick.occupied.begin(), brick.occupied.end());
    b.known().assign(brick.known.begin(), brick.known.end());
  }
}

}  // namespace goshawk::conversions
