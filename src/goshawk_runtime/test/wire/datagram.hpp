#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace goshawk::runtime_test {

using RawBytes = std::vector<std::byte>;

// Kinds of submessages, and flags of DATA.
constexpr std::uint8_t kAcknack = 6, kHeartbeat = 7, kGap = 8, kInfoTime = 9, kInfoSource = 12,
                       kInfoDestination = 14, kNackFrag = 18, kData = 21, kDataFrag = 22;
constexpr unsigned kInlineQos = 2, kHasData = 4, kHasKey = 8;

/// Numbers in little-endian order, as most senders write them.
class Body {
 public:
  Body& u8(std::uint8_t value) { return number(value, 1); }
  Body& u16(std::uint16_t value) { return number(value, 2); }
  Body& u32(std::uint32_t value) { return number(value, 4); }
  Body& sequence_number(std::int64_t value) {
    return u32(std::uint32_t(value >> 32)).u32(std::uint32_t(value));
  }
  Body& entity(std::uint32_t id) {
    for (int shift = 24; shift >= 0; shift -= 8) u8(std::uint8_t(id >> shift));
    return *this;
  }
  Body& zeros(std::size_t count) {
    bytes.resize(bytes.size() + count);
    return *this;
  }
  Body& text(std::string_view text) {  // as CDR: length, characters, zero, padding
    u32(std::uint32_t(text.size() + 1));
    for (const char c : text) u8(std::uint8_t(c));
    u8(0);
    return zeros((4 - bytes.size() % 4) % 4);
  }
  Body& append(const Body& other) {
    bytes.insert(bytes.end(), other.bytes.begin(), other.bytes.end());
    return *this;
  }
  Body& parameter(std::uint16_t id, const Body& value) {
    return u16(id).u16(std::uint16_t(value.bytes.size())).append(value);
  }

  RawBytes bytes;

 private:
  Body& number(std::uint64_t value, int size) {
    for (int k = 0; k < size; ++k) bytes.push_back(std::byte(value >> 8 * k));
    return *this;
  }
};

/// A header of RTPS 2.2, then submessages.
class Datagram {
 public:
  static constexpr std::uint8_t kLittleEndian = 1;

  explicit Datagram(std::uint16_t vendor = 0x010f, std::uint8_t sender = 7) {
    body_.u8('R').u8('T').u8('P').u8('S').u8(2).u8(2);
    body_.u8(std::uint8_t(vendor >> 8)).u8(std::uint8_t(vendor)).zeros(11).u8(sender);
  }
  Datagram& add(std::uint8_t kind, const Body& body, unsigned flags = 0) {
    return add(kind, body, flags, std::uint16_t(body.bytes.size()));
  }
  Datagram& add(std::uint8_t kind, const Body& body, unsigned flags, std::uint16_t claimed) {
    body_.u8(kind).u8(std::uint8_t(flags | kLittleEndian)).u16(claimed).append(body);
    return *this;
  }
  const RawBytes& bytes() const { return body_.bytes; }

 private:
  Body body_;
};

}  // namespace goshawk::runtime_test
