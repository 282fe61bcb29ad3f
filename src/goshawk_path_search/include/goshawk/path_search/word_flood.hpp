#pragma once

#include <cstdint>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/path_search/bucket_queue.hpp"
#include "goshawk/path_search/choices.hpp"
#include "goshawk/path_search/labels.hpp"

namespace goshawk::path_search {

/// What a set of voxels can reach, 64 voxels of a row at a time, those nearest to a wanted voxel
/// first. It mostly meets that voxel after a few hundred words, and a small closed space is full
/// soon: both say at once whether there is a way. Under no_squeeze every move splits into straight
/// ones, so voxels are joined by faces; under squeeze by faces, edges and corners.
///
/// Memory: 24 bytes for each 64 voxels, mapped where a flood gets to.
class WordFlood {
 public:
  enum class State {
    none,    // no flood
    open,    // not done
    met,     // the wanted voxel is reached
    closed,  // all that can be reached is, the wanted voxel is not among it
  };

  explicit WordFlood(CornerRule rule) : squeeze_(rule == CornerRule::squeeze) {}

  /// The map changed.
  void forget() { state_ = State::none; }
  State state() const { return state_; }

  /// Begins anew. @param blocked the map, the same until forget()
  /// @pre `wanted` and the sources are inside and free @return false if there is no memory
  bool start(const BitGrid& blocked, Index3 wanted);
  void add_source(const BitGrid& blocked, Index3 source);

  /// Goes on by so many words at most. @pre state() is not none
  State advance(const BitGrid& blocked, int words);
  /// Of this flood.
  int words_done() const { return done_; }

  /// @pre state() is not none, the voxel inside
  bool contains(Index3 voxel) const;

  /// Is it already known that there is a way between them? @pre voxels inside
  bool joins(Index3 a, Index3 b) const {
    return state_ != State::none && sources_ == 1 && contains(a) && contains(b);
  }

 private:
  struct Word {
    std::uint64_t flood;    // which flood the rest belongs to
    std::uint64_t reached;  // voxels
    std::uint64_t pending;  // of them, those whose neighbours were not looked at
  };
  struct Place {
    int word, y, z;
  };

  std::size_t number(Place p) const {
    return (std::size_t(p.z) * std::size_t(size_.y) + std::size_t(p.y)) * words_x_ +
           std::size_t(p.word);
  }
  bool resize(Index3 size);
  void spread(const BitGrid& blocked, Place from, std::uint64_t voxels);
  void add(const BitGrid& blocked, Place to, std::uint64_t voxels);
  Cost distance(Place p) const;

  bool squeeze_;
  State state_ = State::none;
  Index3 size_;
  std::size_t words_x_ = 0;
  std::uint64_t flood_ = 0;
  Index3 wanted_;
  int sources_ = 0;  // what one source reaches is joined
  int done_ = 0;
  LabelMemory memory_;  // of words_
  Word* words_ = nullptr;
  BucketQueue queue_;
};

}  // namespace goshawk::path_search
