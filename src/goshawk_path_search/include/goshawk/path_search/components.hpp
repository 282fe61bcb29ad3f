#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/path_search/choices.hpp"

namespace goshawk::path_search {

/// Which free voxels can reach each other. Under no_squeeze every move splits into straight ones,
/// so voxels are joined by faces; under squeeze by faces, edges and corners.
///
/// The map is cut into bricks of 64 x 8 x 8 voxels. Runs of free voxels along x are united within
/// each brick (rows that equal a neighbouring row share its runs), then the components of
/// neighbouring bricks. A change of the map costs the bricks that it meets and one pass over the
/// components of all bricks. The work is done in portions, so that a search can do it beside its
/// own. Memory: 0.07 to 0.45 bytes a voxel, by the number of runs.
class Components {
 public:
  explicit Components(CornerRule rule);

  /// The map changed: nothing is known until advance() has followed it.
  void forget() { phase_ = Phase::behind; }
  bool ready() const { return phase_ == Phase::ready; }

  /// Does a portion of the work that is left.
  /// @param blocked the map, the same until forget() @param bricks how many to look at, at most
  /// @return ready()
  bool advance(const BitGrid& blocked, int bricks);

  /// @pre ready(), both voxels inside and free
  bool joined(Index3 a, Index3 b) const { return root_of(a) == root_of(b); }

 private:
  static constexpr int kRows = 64;   // of a brick
  static constexpr int kSides = 13;  // neighbouring bricks that come before, at most
  static constexpr std::uint16_t kNoRun = 0xFFFF;
  enum class Phase { behind, labelling, linking, ready };

  /// A component of this brick touches one of the neighbour on that side.
  struct Link {
    std::uint16_t own;
    std::uint16_t other;
    std::uint8_t side;
    friend bool operator==(const Link&, const Link&) = default;
  };
  struct Brick {
    std::array<std::uint16_t, kRows> first_run{};  // of each row, kNoRun for one without
    std::vector<std::uint16_t> component;          // by run
    std::vector<Link> links;
    std::uint32_t base = 0;  // of its components in roots_
    std::uint32_t components = 0;
    bool stale = true;     // label it again
    bool unlinked = true;  // look for its links again
  };
  struct RowPair {
    std::uint8_t own;
    std::uint8_t other;
  };
  /// The first runs of two rows: equal ones tell of equal rows.
  struct RunPair {
    std::uint16_t own = kNoRun;
    std::uint16_t other = kNoRun;
    bool is_new(const RunPair& last) const {
      return own != kNoRun && other != kNoRun && !(own == last.own && other == last.other);
    }
  };
  struct Side {
    Index3 offset;  // [bricks]
    std::vector<RowPair> rows;
  };

  std::vector<RowPair> row_pairs(Index3 offset) const;
  void follow(const BitGrid& blocked);
  void mark_changes(const BitGrid& blocked, BitGrid::Rows rows);
  void mark(Index3 brick);
  void number_runs(Index3 at, Brick& brick);
  void label(Index3 at, Brick& brick);
  void link(Index3 at, Brick& brick);
  void unite_all();
  class BrickRows;
  std::uint64_t free_row(Index3 brick, int row) const;
  bool contains(Index3 brick) const;
  Index3 place(std::size_t brick) const;
  std::size_t number(Index3 brick) const {
    return (std::size_t(brick.z) * std::size_t(count_.y) + std::size_t(brick.y)) *
               std::size_t(count_.x) +
           std::size_t(brick.x);
  }
  std::uint32_t root_of(Index3 voxel) const;

  int reach_;                    // 0: by faces, 1: by edges and corners, too
  std::vector<RowPair> within_;  // of one brick
  std::vector<Side> sides_;
  Phase phase_ = Phase::behind;
  std::size_t next_ = 0;  // brick of the phase
  BitGrid held_;          // what the bricks say, or are about to
  Index3 count_;          // bricks
  std::vector<Brick> bricks_;
  std::vector<std::uint32_t> roots_;  // by component; a root of itself once ready
  // Of the brick at work.
  std::array<std::uint64_t, kRows> rows_{};
  std::vector<std::uint16_t> runs_;
};

}  // namespace goshawk::path_search
