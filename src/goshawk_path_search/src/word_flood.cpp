#include "goshawk/path_search/word_flood.hpp"

#include <algorithm>

namespace goshawk::path_search {
namespace {

// All voxels of the runs of `free` that hold one of `some`. @pre some is a part of free
std::uint64_t whole_runs(std::uint64_t some, std::uint64_t free) {
  if (free == ~std::uint64_t{0}) return free;
  // Upwards a sum carries through the run; downwards in steps that double.
  std::uint64_t runs = free & ((free ^ (free + some)) | some);
  std::uint64_t through = free;
  for (int step = 1; step < 64; step *= 2) {
    runs |= through & (runs >> step);
    through &= through >> step;
  }
  return runs;
}

}  // namespace

bool WordFlood::resize(Index3 size) {
  state_ = State::none;
  size_ = {};
  words_x_ = std::size_t(size.x - 1) / 64 + 1;
  flood_ = 0;
  const std::size_t words = words_x_ * std::size_t(size.y) * std::size_t(size.z);
  if (!memory_.resize(words * (sizeof(Word) / sizeof(Label)))) return false;
  words_ = reinterpret_cast<Word*>(memory_.data());
  size_ = size;
  return true;
}

bool WordFlood::start(const BitGrid& blocked, Index3 wanted) {
  if (!(blocked.size() == size_) && !resize(blocked.size())) return false;
  ++flood_;
  wanted_ = wanted;
  sources_ = done_ = 0;
  queue_.clear(0);
  state_ = State::open;
  return true;
}

void WordFlood::add_source(const BitGrid& blocked, Index3 source) {
  ++sources_;
  add(blocked, {source.x >> 6, source.y, source.z}, std::uint64_t{1} << (source.x & 63));
}

WordFlood::State WordFlood::advance(const BitGrid& blocked, int words) {
  for (; state_ == State::open; --words) {
    if (contains(wanted_)) {
      state_ = State::met;
    } else if (!queue_.advance()) {
      state_ = State::closed;
    }
    if (state_ != State::open || words == 0) break;
    const std::size_t at = queue_.pop().node;
    const std::size_t row = at / words_x_;
    const Place place{int(at % words_x_), int(row % std::size_t(size_.y)),
                      int(row / std::size_t(size_.y))};
    const std::uint64_t voxels = words_[at].pending;
    words_[at].pending = 0;
    ++done_;
    spread(blocked, place, voxels);
  }
  return state_;
}

void WordFlood::spread(const BitGrid& blocked, Place from, std::uint64_t voxels) {
  const std::uint64_t beside = squeeze_ ? voxels | voxels << 1 | voxels >> 1 : voxels;
  for (int z = std::max(from.z - 1, 0); z <= std::min(from.z + 1, size_.z - 1); ++z) {
    for (int y = std::max(from.y - 1, 0); y <= std::min(from.y + 1, size_.y - 1); ++y) {
      const int apart = std::abs(y - from.y) + std::abs(z - from.z);
      if (apart > 1 && !squeeze_) continue;
      if (apart > 0) add(blocked, {from.word, y, z}, beside);
      if (apart > 0 && !squeeze_) continue;
      if ((voxels & 1U) != 0 && from.word > 0) {
        add(blocked, {from.word - 1, y, z}, std::uint64_t{1} << 63);
      }
      if (voxels >> 63 != 0 && std::size_t(from.word) + 1 < words_x_) {
        add(blocked, {from.word + 1, y, z}, 1);
      }
    }
  }
}

void WordFlood::add(const BitGrid& blocked, Place to, std::uint64_t voxels) {
  std::uint64_t free = ~blocked.row(to.y, to.z)[to.word];
  const int left = size_.x - 64 * to.word;
  if (left < 64) free &= ~std::uint64_t{0} >> (64 - left);
  voxels &= free;
  if (voxels == 0) return;
  Word& word = words_[number(to)];
  if (word.flood != flood_) word = {flood_, 0, 0};
  voxels &= ~word.reached;
  if (voxels == 0) return;
  const std::uint64_t more = whole_runs(voxels, free) & ~word.reached;
  word.reached |= more;
  if (word.pending == 0) queue_.push(std::uint32_t(number(to)), distance(to), 0);
  word.pending |= more;
}

// One bucket of the queue for each voxel of distance.
Cost WordFlood::distance(Place p) const {
  const int x = wanted_.x - 64 * p.word;
  const int along = x < 0 ? -x : std::max(0, x - 63);
  return Cost(along + std::abs(wanted_.y - p.y) + std::abs(wanted_.z - p.z)) << BucketQueue::kShift;
}

bool WordFlood::contains(Index3 voxel) const {
  const Word& word = words_[number({voxel.x >> 6, voxel.y, voxel.z})];
  return word.flood == flood_ && ((word.reached >> (voxel.x & 63)) & 1U) != 0;
}

}  // namespace goshawk::path_search
