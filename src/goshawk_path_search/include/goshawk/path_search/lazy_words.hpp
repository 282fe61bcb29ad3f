#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "goshawk/path_search/populate.hpp"

namespace goshawk::path_search {

/// 64-bit words that are derived from others and made when they are first asked for. What nobody
/// asks for takes address space alone, unless populate() was called; a change costs one bit for each
/// word that depends on it.
class LazyWords {
 public:
  /// None is known.
  void resize(std::size_t words) {
    size_ = words;
    words_.reset(new std::uint64_t[words]);  // not written, so that no page is made yet
    known_.assign(words / 64 + 1, 0);
  }
  /// For those who will ask for many: asks for the memory now.
  void populate() { path_search::populate(words_.get(), size_ * sizeof(std::uint64_t)); }
  void forget_all() { known_.assign(known_.size(), 0); }
  void forget(std::size_t word) { known_[word >> 6] &= ~(std::uint64_t{1} << (word & 63)); }
  bool is_known(std::size_t word) const { return (known_[word >> 6] >> (word & 63)) & 1U; }

  void set(std::size_t word, std::uint64_t value) {
    words_[word] = value;
    known_[word >> 6] |= std::uint64_t{1} << (word & 63);
  }
  /// @pre is_known(word)
  std::uint64_t operator[](std::size_t word) const { return words_[word]; }

 private:
  std::unique_ptr<std::uint64_t[]> words_;
  std::size_t size_ = 0;
  std::vector<std::uint64_t> known_;  // one bit a word
};

}  // namespace goshawk::path_search
