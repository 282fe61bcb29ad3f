#include "handshake_datagrams.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "datagram_check.hpp"
#include "submessage.hpp"

namespace goshawk::runtime::wire {
namespace {

using Prefix = SenderTable::Prefix;

constexpr std::uint32_t kDiscoveryWriter = 0x000100c2, kDiscoveryReader = 0x000100c7;
constexpr std::uint32_t kHandshakeWriter = 0x000201c3;
constexpr std::uint32_t kParticipantEntity = 0x000001c1;
constexpr std::size_t kGuidSize = 16;     // [byte]
constexpr std::uint8_t kGreeting = 0xf7;  // of the submessages that are a vendor's own
constexpr std::string_view kMark = "goshawk greeting";  // whole words of four bytes

/// A little-endian datagram.
class DatagramWriter {
 public:
  explicit DatagramWriter(const Prefix& from) {
    constexpr std::array<std::uint8_t, 8> kBegin{'R', 'T', 'P', 'S', 2, 3, 1, 15};
    for (const std::uint8_t octet : kBegin) u8(octet);
    prefix(from);
  }
  DatagramWriter& submessage(std::uint8_t kind, std::uint8_t flags, std::size_t size) {
    return u8(kind).u8(flags | 1U).number(size, 2);
  }
  DatagramWriter& parameter(std::uint16_t id, std::size_t size) {
    return number(id, 2).number(size, 2);
  }
  DatagramWriter& u8(unsigned value) {
    bytes_.push_back(std::byte(value));
    return *this;
  }
  DatagramWriter& number(std::uint64_t value, int size) {
    for (int k = 0; k < size; ++k) u8(unsigned(value >> 8 * k & 0xff));
    return *this;
  }
  DatagramWriter& big_endian(std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) u8(value >> shift & 0xff);
    return *this;
  }
  DatagramWriter& sequence_number(std::int64_t value) {
    return number(std::uint64_t(value) >> 32, 4).number(std::uint64_t(value) & 0xffffffff, 4);
  }
  DatagramWriter& prefix(const Prefix& of) {
    bytes_.insert(bytes_.end(), of.begin(), of.end());
    return *this;
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

// The payload of a DATA; empty if it is not one of that writer, or has none.
Bytes payload_of(const Submessage& of, std::uint32_t from_writer) {
  if (of.kind != data || !of.has(2) || of.has(1)) return {};
  Cursor at = of.cursor();
  at.skip(2);
  const std::size_t to_payload = at.u16();
  at.skip(4);  // the reader
  if (at.entity() != from_writer || to_payload < 16) return {};
  at.skip(4 + to_payload - at.at());
  return at.ok() ? at.rest() : Bytes{};
}

std::optional<HandshakeMessage> read_message(Bytes payload, const Prefix& own) {
  constexpr std::size_t kBeforeMessage = 4;
  if (payload.size() < kBeforeMessage) return {};
  Cursor at(payload.subspan(kBeforeMessage), (payload[1] & std::byte{1}) != std::byte{0});
  HandshakeMessage message;
  at.skip(kGuidSize);
  message.number = at.sequence_number();
  const Bytes answered = at.take(kGuidSize);
  at.skip(8);
  const Bytes receiver = at.take(kGuidSize);
  if (!at.ok() || !std::ranges::equal(receiver.first(kPrefix), own)) return {};
  message.is_request =
      std::ranges::all_of(answered, [](std::byte octet) { return octet == std::byte{0}; });
  return message;
}

}  // namespace

std::optional<HandshakeMessage> handshake_message(Bytes datagram, const Prefix& own) {
  Cursor at(datagram.subspan(kHeader), false);
  for (Submessage of; at.left() > 0 && next(at, of);) {
    const Bytes payload = payload_of(of, kHandshakeWriter);
    if (!payload.empty()) return read_message(payload, own);
  }
  return {};
}

std::vector<std::byte> make_greeting(const Prefix& from, const Prefix& to) {
  DatagramWriter out(from);
  out.submessage(info_destination, 0, kPrefix).prefix(to);
  out.submessage(kGreeting, 0, kMark.size());
  for (const char c : kMark) out.u8(std::uint8_t(c));
  return out.take();
}

bool is_greeting(Bytes datagram, const Prefix& own) {
  constexpr std::size_t kSize = kHeader + 4 + kPrefix + 4 + kMark.size();
  if (datagram.size() != kSize) return false;
  Cursor at(datagram.subspan(kHeader), false);
  Submessage to, mark;
  return next(at, to) && next(at, mark) && to.kind == info_destination &&
         std::ranges::equal(to.body, own) && mark.kind == kGreeting &&
         std::ranges::equal(mark.body, std::as_bytes(std::span(kMark)));
}

std::vector<std::byte> make_farewell(const Prefix& of) {
  constexpr std::uint16_t kKeyHash = 0x0070, kStatusInfo = 0x0071, kEnd = 1;
  constexpr std::uint32_t kDisposedAndUnregistered = 3;
  constexpr std::size_t kFixed = 20, kParameters = 4 + kGuidSize + 8 + 4;
  DatagramWriter out(of);
  out.submessage(data, 2, kFixed + kParameters).number(0, 2).number(16, 2);
  out.big_endian(kDiscoveryReader).big_endian(kDiscoveryWriter);
  out.sequence_number(kMostSequence - 1);  // later than what that one has said
  out.parameter(kKeyHash, kGuidSize).prefix(of).big_endian(kParticipantEntity);
  out.parameter(kStatusInfo, 4).big_endian(kDisposedAndUnregistered);
  out.parameter(kEnd, 0);
  return out.take();
}

}  // namespace goshawk::runtime::wire
