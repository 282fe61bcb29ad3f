#include "brick_archive.hpp"

namespace goshawk::map_server {
namespace {

using Word = BrickMap::Word;
constexpr std::int64_t kOverhead = 112;  // of a node, its share of the table, and the order

// Two masks say which rows are 0 and which are all ones; the rest follows.
void pack(const Brick::Words& rows, std::vector<Word>& words) {
  const std::size_t head = words.size();
  words.insert(words.end(), {0, 0});
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Word bit = Word{1} << row;
    if (rows[row] == 0) {
      words[head] |= bit;
    } else if (rows[row] == ~Word{0}) {
      words[head + 1] |= bit;
    } else {
      words.push_back(rows[row]);
    }
  }
}

const Word* unpack(const Word* from, Brick::Words& rows) {
  const Word zero = *from++, ones = *from++;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    rows[row] = (zero >> row & 1U) != 0 ? 0 : (ones >> row & 1U) != 0 ? ~Word{0} : *from++;
  }
  return from;
}

}  // namespace

std::int64_t BrickArchive::bytes_of(const Entry& entry) {
  return kOverhead + 8 * std::int64_t(entry.words.capacity());
}

BrickArchive::Kept BrickArchive::unpacked(const Entry& entry) {
  Kept kept;
  unpack(unpack(entry.words.data(), kept.known), kept.raw);
  return kept;
}

void BrickArchive::keep(Index3 brick, const BrickMap::Bits& bits) {
  std::vector<Word> packed;
  pack(bits.known, packed);
  pack(bits.raw, packed);
  packed.shrink_to_fit();
  Entry& entry = kept_[brick];
  entry = {std::move(packed), next_number_++};
  bytes_ += bytes_of(entry);
  order_.emplace_back(entry.number, brick);
  if (order_.size() > 2 * kept_.size() + 1024) drop_taken();
  while (bytes_ > max_bytes_ && !order_.empty()) {
    const auto [number, oldest] = order_.front();
    order_.pop_front();
    const auto found = kept_.find(oldest);
    if (found == kept_.end() || found->second.number != number) continue;
    bytes_ -= bytes_of(found->second);
    kept_.erase(found);
    ++forgotten_;
  }
}

std::optional<BrickArchive::Kept> BrickArchive::take(Index3 brick) {
  const auto found = kept_.find(brick);
  if (found == kept_.end()) return {};
  const Kept kept = unpacked(found->second);
  bytes_ -= bytes_of(found->second);
  kept_.erase(found);
  return kept;
}

// Flying to and fro must not let the order grow for ever.
void BrickArchive::drop_taken() {
  std::erase_if(order_, [this](const auto& entry) {
    const auto found = kept_.find(entry.second);
    return found == kept_.end() || found->second.number != entry.first;
  });
}

}  // namespace goshawk::map_server
