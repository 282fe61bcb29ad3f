#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace goshawk {

/// A fixed number of 64-bit words that copies share: a copy costs one count. own() makes the words
/// one's own before a write, so that no other copy ever sees a change.
///
/// As with std::shared_ptr, copies may be used in different threads at the same time, one object
/// may not.
class SharedWords {
 public:
  using Word = std::uint64_t;

  SharedWords() = default;
  SharedWords(std::size_t count, Word value);
  SharedWords(const SharedWords& other) : words_(other.words_) { retain(); }
  SharedWords(SharedWords&& other) noexcept : words_(other.words_) { other.words_ = nullptr; }
  SharedWords& operator=(SharedWords other) noexcept {
    Word* mine = words_;
    words_ = other.words_;
    other.words_ = mine;
    return *this;
  }
  ~SharedWords() { release(); }

  const Word* data() const { return words_; }

  /// @return the words for writing, cloned first if another copy shares them
  Word* own() {
    // Acquire: what the last other owner read, it read before it let go.
    if (header()->owners.load(std::memory_order_acquire) != 1) clone();
    return words_;
  }

  friend bool share(const SharedWords& a, const SharedWords& b) { return a.words_ == b.words_; }

 private:
  struct Header {
    std::atomic<std::size_t> owners;
    std::size_t count;
  };

  static Word* allocate(std::size_t count);
  Header* header() const { return reinterpret_cast<Header*>(words_) - 1; }
  void retain() const {
    if (words_ != nullptr) header()->owners.fetch_add(1, std::memory_order_relaxed);
  }
  void release();
  void clone();

  Word* words_ = nullptr;  // behind a Header
};

}  // namespace goshawk
