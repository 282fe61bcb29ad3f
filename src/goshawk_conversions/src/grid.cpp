#include "goshawk/conversions/grid.hpp"

#include <fmt/format.h>

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
  auto grown = BitGrid::from_words(grid.geometry.size, true, m.grown());
  if (!grown) return grown.error();
  grid.grown = *std::move(grown);
  if (!m.known().empty()) {
    auto known = BitGrid::from_words(grid.geometry.size, false, m.known());
    if (!known) return known.error();
    grid.known = *std::move(known);
  }
  if (!m.raw().empty()) {
    auto raw = BitGrid::from_words(grid.geometry.size, true, m.raw());
    if (!raw) return raw.error();
    grid.raw = *std::move(raw);
  }
  grid.version = m.version();
  grid.inflation_m = m.inflation();
  grid.unknown_is_occupied = m.unknown_is_occupied();
  grid.unknown_grows = m.unknown_grows();
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
  m.unknown_grows(grid.unknown_grows);
  grid.grown.write_words(m.grown());
  grid.known.write_words(m.known());
  grid.raw.write_words(m.raw());
}

Result<GridUpdate> from_msg(const goshawk_msgs::msg::VoxelGridUpdate& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a voxel grid update"); !status) {
    return status.error();
  }
  GridUpdate update{m.from_version(),
                    m.to_version(),
                    {m.shift_word_x(), m.shift_brick_y(), m.shift_brick_z()},
                    {}};
  update.bricks.reserve(m.bricks().size());
  for (const auto& b : m.bricks()) {
    const bool raw = !b.raw().empty();
    if (b.grown().size() != Brick::kWords || b.known().size() != Brick::kWords ||
        (raw && b.raw().size() != Brick::kWords)) {
      return fail(ErrorCode::invalid_input,
                  fmt::format("a brick of an update has {} grown, {} known and {} raw words: 64, "
                              "64, and 64 or none are needed",
                              b.grown().size(), b.known().size(), b.raw().size()));
    }
    constexpr std::uint32_t kMax = 1U << 28;  // far beyond any grid; apply() has the exact check
    Brick brick;
    brick.index = {int(std::min(b.word_x(), kMax)), int(std::min(b.brick_y(), kMax)),
                   int(std::min(b.brick_z(), kMax))};
    std::ranges::copy(b.grown(), brick.grown.begin());
    std::ranges::copy(b.known(), brick.known.begin());
    if (raw) std::ranges::copy(b.raw(), brick.raw.emplace().begin());
    update.bricks.push_back(brick);
  }
  return update;
}

void fill_msg(const GridUpdate& update, goshawk_msgs::msg::VoxelGridUpdate& m) {
  m.from_version(update.from_version);
  m.to_version(update.to_version);
  m.shift_word_x(update.shift.x);
  m.shift_brick_y(update.shift.y);
  m.shift_brick_z(update.shift.z);
  m.bricks().resize(update.bricks.size());
  for (std::size_t k = 0; k < update.bricks.size(); ++k) {
    const Brick& brick = update.bricks[k];
    auto& b = m.bricks()[k];
    b.word_x(std::uint32_t(brick.index.x));
    b.brick_y(std::uint32_t(brick.index.y));
    b.brick_z(std::uint32_t(brick.index.z));
    b.grown().assign(brick.grown.begin(), brick.grown.end());
    b.known().assign(brick.known.begin(), brick.known.end());
    b.raw().clear();
    if (brick.raw) b.raw().assign(brick.raw->begin(), brick.raw->end());
  }
}

}  // namespace goshawk::conversions
