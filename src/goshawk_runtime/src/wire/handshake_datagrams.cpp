#include "handshake_datagrams.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "datagram_check.hpp"
#include "submessage.hpp"

namespace goshawk::runtime::wire {
namespace {

using Prefix = SenderTable::Prefix;

constexpr std::uint32_t kDiscoveryWriter = 0x000100c2;
constexpr std::uint32_t kHandshakeWriter = 0x000201c3;
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
  DatagramWriter& u8(unsigned value) {
    bytes_.push_back(std::byte(value));
    return *this;
  }
  DatagramWriter& number(std::uint64_t value, int size) {
    for (int k = 0; k < size; ++k) u8(unsigned(value >> 8 * k & 0xff));
    return *this;
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

/// [byte] where an announcement and its numbers stand in a datagram.
struct Places {
  std::size_t begin = 0, end = 0;  // of its submessage
  std::size_t number = 0;          // of its sequence number
  std::size_t lease = 0;           // of its lease duration
  bool number_is_little_endian = true, lease_is_little_endian = true;
};

// In a list of parameters. @return its value, at least `size` bytes; nothing if there is none
Bytes parameter_in(Cursor at, std::uint16_t wanted, std::size_t size) {
  constexpr std::uint16_t kEnd = 1;
  while (at.ok() && at.left() >= 4) {
    const std::uint16_t id = at.u16();
    const Bytes value = at.take(at.u16());
    if (id == kEnd) return {};
    if (id == wanted && value.size() >= size) return value;
  }
  return {};
}

Bytes lease_in(Bytes payload) {
  constexpr std::size_t kBeforeParameters = 4;
  if (payload.size() < kBeforeParameters) return {};
  const bool little_endian = (payload[1] & std::byte{1}) != std::byte{0};
  return parameter_in({payload.subspan(kBeforeParameters), little_endian}, 0x0002, 8);
}

// Of a DATA: disposed or unregistered.
bool has_left(const Submessage& of) {
  if (!of.has(2)) return true;  // a key alone, or nothing
  if (!of.has(1)) return false;
  Cursor at = of.cursor();
  at.skip(2);
  const std::size_t to_parameters = at.u16();
  at.skip(to_parameters);
  const Bytes status = parameter_in({at.rest(), of.has(0)}, 0x0071, 4);
  return !status.empty() && status[3] != std::byte{0};
}

// Of the first announcement in a datagram; nothing if there is none.
std::optional<Places> announced_in(Bytes datagram) {
  constexpr std::size_t kNumberAt = 12;
  Cursor at(datagram.subspan(kHeader), false);
  for (Submessage of; at.left() > 0 && next(at, of);) {
    const Bytes payload = payload_of(of, kDiscoveryWriter);
    const Bytes lease = lease_in(payload);
    if (lease.empty()) continue;
    const std::size_t body = std::size_t(of.body.data() - datagram.data());
    return Places{.begin = body - 4,
                  .end = body + of.body.size(),
                  .number = body + kNumberAt,
                  .lease = std::size_t(lease.data() - datagram.data()),
                  .number_is_little_endian = of.has(0),
                  .lease_is_little_endian = (payload[1] & std::byte{1}) != std::byte{0}};
  }
  return {};
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

bool is_announcement(Bytes datagram) {
  return announced_in(datagram).has_value();
}

bool is_farewell(Bytes datagram) {
  constexpr std::size_t kWriterAt = 8;
  Cursor at(datagram.subspan(kHeader), false);
  for (Submessage of; at.left() > 0 && next(at, of);) {
    if (of.kind != data) continue;
    Cursor in = of.cursor();
    in.skip(kWriterAt);
    if (in.entity() == kDiscoveryWriter && has_left(of)) return true;
  }
  return false;
}

std::vector<std::byte> make_brief(Bytes announcement) {
  constexpr std::uint32_t kBrief = 42'949'673;  // 10 ms in units of 2^-32 s
  const auto places = announced_in(announcement).value();
  std::vector<std::byte> brief(announcement.begin(), announcement.end());
  const auto put = [&](std::size_t at, std::uint32_t value, bool little_endian) {
    for (int k = 0; k < 4; ++k) {
      brief[at + std::size_t(k)] = std::byte(value >> 8 * (little_endian ? k : 3 - k) & 0xff);
    }
  };
  const auto number = std::uint64_t(kMostSequence - 1);
  put(places.number, std::uint32_t(number >> 32), places.number_is_little_endian);
  put(places.number + 4, std::uint32_t(number), places.number_is_little_endian);
  put(places.lease, 0, places.lease_is_little_endian);
  put(places.lease + 4, kBrief, places.lease_is_little_endian);
  brief.erase(brief.begin() + std::ptrdiff_t(places.end), brief.end());
  brief.erase(brief.begin() + kHeader, brief.begin() + std::ptrdiff_t(places.begin));
  return brief;
}

}  // namespace goshawk::runtime::wire
