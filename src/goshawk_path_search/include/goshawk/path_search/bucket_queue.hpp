#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "goshawk/path_search/move_cost.hpp"
#include "goshawk/path_search/populate.hpp"

namespace goshawk::path_search {

/// A priority queue of nodes over integer keys: one stack for each 1/16 voxel of key. The order
/// inside a bucket is last in, first out, which follows the newest and so mostly the largest g.
/// The search stays exact because it may expand a node again (grid_search.cpp).
///
/// Buckets and entries keep their memory; clear() costs as much as the buckets that were used.
class BucketQueue {
 public:
  struct Entry {
    std::uint32_t node;
    std::uint32_t next;
    std::uint32_t rest;  // key - the bucket's lowest key
    std::uint32_t note;
  };
  static constexpr int kShift = 17;
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Memory for so many entries, now.
  void reserve(std::size_t entries) {
    entries_.reserve(entries);
    populate(entries_.data(), entries * sizeof(Entry));
    if (heads_.empty()) grow(0);
  }

  /// Empties the queue. @param base a lower bound on the keys that come; smaller ones count as it
  void clear(Cost base) {
    if (last_ != kNone) {
      std::fill(heads_.begin(), heads_.begin() + last_ + 1, kNone);
      std::fill(used_.begin(), used_.begin() + (last_ >> 6) + 1, 0U);
    }
    entries_.clear();
    recycled_ = kNone;
    base_ = base;
    first_ = 0;
    last_ = kNone;
  }

  /// @param note handed out with it
  void push(std::uint32_t node, Cost key, std::uint32_t note) {
    const Cost above = std::max(key - base_, Cost{0});
    const auto bucket = std::uint32_t(above >> kShift);
    if (bucket >= heads_.size()) grow(bucket);
    const std::uint32_t slot = take_slot();
    entries_[slot] = {node, heads_[bucket], std::uint32_t(above & ((Cost{1} << kShift) - 1)), note};
    heads_[bucket] = slot;
    used_[bucket >> 6] |= std::uint64_t{1} << (bucket & 63);
    first_ = std::min(first_, bucket);
    last_ = last_ == kNone ? bucket : std::max(last_, bucket);
  }

  /// Moves on to the first bucket that is not empty. @return false where none is
  bool advance() {
    if (last_ == kNone) return false;
    for (std::uint32_t w = first_ >> 6; w <= last_ >> 6; ++w) {
      if (used_[w] == 0) continue;
      first_ = w * 64 + std::uint32_t(std::countr_zero(used_[w]));
      return true;
    }
    return false;
  }

  /// The lowest key that the current bucket can hold. @pre advance()
  Cost lowest_key() const { return base_ + (Cost{first_} << kShift); }

  /// Takes the newest entry of the current bucket. @pre advance()
  Entry pop() {
    const std::uint32_t slot = heads_[first_];
    const Entry entry = entries_[slot];
    heads_[first_] = entry.next;
    if (entry.next == kNone) used_[first_ >> 6] &= ~(std::uint64_t{1} << (first_ & 63));
    entries_[slot].next = recycled_;
    recycled_ = slot;
    return entry;
  }

 private:
  void grow(std::uint32_t bucket) {
    const std::size_t buckets = (std::size_t{bucket} * 3 / 2 + 1024) / 64 * 64;
    heads_.resize(buckets, kNone);
    used_.resize(buckets / 64, 0U);
  }

  std::uint32_t take_slot() {
    if (recycled_ != kNone) {
      const std::uint32_t slot = recycled_;
      recycled_ = entries_[slot].next;
      return slot;
    }
    entries_.emplace_back();
    return std::uint32_t(entries_.size() - 1);
  }

  std::vector<std::uint32_t> heads_;  // newest entry of each bucket
  std::vector<std::uint64_t> used_;   // one bit a bucket: not empty
  std::vector<Entry> entries_;
  std::uint32_t recycled_ = kNone;
  Cost base_ = 0;
  std::uint32_t first_ = 0;
  std::uint32_t last_ = kNone;
};

}  // namespace goshawk::path_search
