#pragma once

#include <cstddef>
#include <cstdint>

#include "cursor.hpp"

namespace goshawk::runtime::wire {

constexpr std::size_t kHeader = 20;  // [byte] "RTPS", version, vendor, GUID prefix
constexpr std::size_t kPrefix = 12;  // [byte] of a GUID

enum Kind : std::uint8_t {  // RTPS 2.5, table 9.13; DDS Security 1.1, 7.4.7
  acknack = 0x06,
  heartbeat = 0x07,
  gap = 0x08,
  info_time = 0x09,
  info_source = 0x0c,
  info_destination = 0x0e,
  nack_fragments = 0x12,
  heartbeat_fragments = 0x13,
  data = 0x15,
  data_fragments = 0x16,
  pad = 0x01,
  secure_body = 0x30,
  secure_prefix = 0x31,
  secure_postfix = 0x32,
  secure_message_prefix = 0x33,
  secure_message_postfix = 0x34,
  first_of_vendor = 0x80,
};

struct Submessage {
  std::uint8_t kind = 0;
  std::uint8_t flags = 0;
  Bytes body{};
  bool last = false;

  bool has(unsigned bit) const { return (flags >> bit & 1U) != 0; }
  Cursor cursor() const { return {body, has(0)}; }
};

/// The next submessage. @return false if it does not lie in the datagram
inline bool next(Cursor& at, Submessage& out) {
  const Bytes head = at.take(2);
  if (head.size() != 2) return false;
  out.kind = std::to_integer<std::uint8_t>(head[0]);
  out.flags = std::to_integer<std::uint8_t>(head[1]);
  Cursor length(at.take(2), out.has(0));
  std::size_t size = length.u16();
  // Zero: to the end of the datagram, but for the two kinds that may be empty.
  if (size == 0 && out.kind != info_time && out.kind != pad) size = at.left();
  out.body = at.take(size);
  out.last = at.left() == 0;
  return at.ok() && (out.last || size % 4 == 0);
}

}  // namespace goshawk::runtime::wire
