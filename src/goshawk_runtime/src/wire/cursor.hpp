#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace goshawk::runtime::wire {

using Bytes = std::span<const std::byte>;

/// Reads numbers from the front of a region of a datagram. What lies past the end reads as zero,
/// and ok() is false from then on: a reader may check once, at the end.
class Cursor {
 public:
  Cursor(Bytes bytes, bool little_endian) : bytes_(bytes), little_endian_(little_endian) {}

  bool ok() const { return ok_; }
  bool little_endian() const { return little_endian_; }
  std::size_t at() const { return at_; }  // [byte] from the front
  std::size_t left() const { return bytes_.size() - at_; }
  Bytes rest() const { return bytes_.subspan(at_); }

  /// The next `count` bytes; none at all if there are fewer.
  Bytes take(std::size_t count) {
    if (count > left()) {
      ok_ = false;
      at_ = bytes_.size();
      return {};
    }
    at_ += count;
    return bytes_.subspan(at_ - count, count);
  }
  void skip(std::size_t count) { take(count); }
  /// To the next multiple of four, or to the end: the last string of a region may lack its padding.
  void align() { at_ = at_ + 3 < bytes_.size() ? (at_ + 3) / 4 * 4 : bytes_.size(); }

  std::uint16_t u16() { return std::uint16_t(number(2)); }
  std::uint32_t u32() { return std::uint32_t(number(4)); }
  /// An RTPS SequenceNumber: the upper half comes first in either byte order.
  std::int64_t sequence_number() {
    const std::uint64_t high = u32();
    return std::int64_t(high << 32 | u32());
  }
  /// An EntityId, which has no byte order.
  std::uint32_t entity() {
    std::uint32_t id = 0;
    for (const std::byte b : take(4)) id = id << 8 | std::to_integer<std::uint32_t>(b);
    return id;
  }

 private:
  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    const Bytes taken = take(size);
    for (std::size_t k = 0; k < taken.size(); ++k) {
      const std::size_t from = little_endian_ ? taken.size() - 1 - k : k;
      value = value << 8 | std::to_integer<std::uint64_t>(taken[from]);
    }
    return value;
  }

  Bytes bytes_;
  bool little_endian_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace goshawk::runtime::wire
