#include "odds_store.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace goshawk::map_server {
namespace {

using Word = OddsStore::Word;
constexpr std::size_t kReserved = 16384;  // bricks: 75 MB of addresses, used as bricks are met

// visit(bit) for each one that is set
template <typename Visit>
void for_bits(Word word, Visit&& visit) {
  for (; word != 0; word &= word - 1) visit(std::countr_zero(word));
}

}  // namespace

void OddsStore::resize(Index3 counts) {
  const auto bricks = std::size_t(counts.x) * std::size_t(counts.y) * std::size_t(counts.z);
  slots_.assign(bricks, -1);
  pool_.clear();
  unused_.clear();
  pool_.reserve(std::min(bricks, kReserved));
}

std::int32_t OddsStore::open(std::size_t brick, const BrickMap::Bits* bits) {
  std::int32_t& slot = slots_[brick];
  if (slot >= 0) return slot;
  if (unused_.empty()) {
    slot = std::int32_t(pool_.size());
    pool_.emplace_back();
  } else {
    slot = unused_.back();
    unused_.pop_back();
    pool_[std::size_t(slot)] = {};
  }
  if (bits == nullptr) return slot;
  Odds& odds = pool_[std::size_t(slot)];
  for (std::size_t row = 0; row < Brick::kWords; ++row) {
    const Word raw = bits->raw[row], free = bits->known[row] & ~raw;
    odds.surely_free[row] = free;
    for_bits(free, [&](int x) { odds.value[row][x] = std::int8_t(model_.least); });
    for_bits(raw, [&](int x) { odds.value[row][x] = std::int8_t(model_.most); });
  }
  return slot;
}

void OddsStore::step(std::int32_t slot, int row, Word missed, Word hit, Word& raw, Word& known) {
  Odds& odds = pool_[std::size_t(slot)];
  std::int8_t* value = odds.value[row];
  Word& surely_free = odds.surely_free[std::size_t(row)];
  known |= missed | hit;
  for_bits(missed & ~hit & ~surely_free, [&](int x) {
    const int now = std::max(value[x] - model_.miss, model_.least);
    value[x] = std::int8_t(now);
    const Word bit = Word{1} << x;
    if (now < model_.occupied) raw &= ~bit;
    if (now == model_.least) surely_free |= bit;
  });
  for_bits(hit, [&](int x) {
    const int now = std::min(value[x] + model_.hit, model_.most);
    value[x] = std::int8_t(now);
    if (now >= model_.occupied) raw |= Word{1} << x;
  });
  surely_free &= ~hit;
}

void OddsStore::settle(std::int32_t slot, int row, Word free, Word occupied) {
  Odds& odds = pool_[std::size_t(slot)];
  for_bits(free, [&](int x) { odds.value[row][x] = std::int8_t(model_.least); });
  for_bits(occupied, [&](int x) { odds.value[row][x] = std::int8_t(model_.most); });
  Word& surely_free = odds.surely_free[std::size_t(row)];
  surely_free = (surely_free | free) & ~occupied;
}

void OddsStore::shift(const std::vector<std::int64_t>& from) {
  std::vector<std::int32_t> moved(slots_.size(), -1);
  for (std::size_t brick = 0; brick < moved.size(); ++brick) {
    if (from[brick] < 0) continue;
    moved[brick] = std::exchange(slots_[std::size_t(from[brick])], -1);
  }
  for (const std::int32_t slot : slots_) {
    if (slot >= 0) unused_.push_back(slot);
  }
  slots_ = std::move(moved);
}

}  // namespace goshawk::map_server
