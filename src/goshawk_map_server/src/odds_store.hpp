#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/core/brick_map.hpp"
#include "goshawk/map_server/odds_model.hpp"

namespace goshawk::map_server {

/// The confidence of each voxel of the bricks that scans have met, in steps of OddsModel.
class OddsStore {
 public:
  using Word = BrickMap::Word;

  explicit OddsStore(const OddsModel& model) : model_(model) {}

  /// For a window of this many bricks. Forgets all.
  void resize(Index3 counts);

  /// The confidence of a brick. One that is not there yet begins as sure as its bits allow.
  /// @param bits may be null: nothing is known
  std::int32_t open(std::size_t brick, const BrickMap::Bits* bits);

  /// One scan's step for a row. @param slot from open() @param raw, known of the row; changed
  void step(std::int32_t slot, int row, Word missed, Word hit, Word& raw, Word& known);
  /// As sure as can be that these voxels are free, and those obstacles.
  void settle(std::int32_t slot, int row, Word free, Word occupied);
  /// @return the slot of a brick that was opened, else -1
  std::int32_t find(std::size_t brick) const { return slots_[brick]; }

  /// @param from of each brick of the window: the brick that it was before, or -1
  void shift(const std::vector<std::int64_t>& from);

  std::size_t memory_bytes() const { return pool_.size() * sizeof(Odds) + 4 * slots_.size(); }

 private:
  struct Odds {
    std::int8_t value[Brick::kWords][64] = {};
    Brick::Words surely_free{};  // those at the least confidence: a miss changes nothing
  };

  OddsModel model_;
  std::vector<std::int32_t> slots_;  // of each brick of the window; -1: none
  std::vector<Odds> pool_;
  std::vector<std::int32_t> unused_;
};

}  // namespace goshawk::map_server
