#include "parameter_check.hpp"

#include <algorithm>
#include <array>

namespace goshawk::runtime::wire {
namespace {

constexpr std::size_t kEncapsulation = 4;  // [byte]
constexpr std::size_t kGuid = 16;          // [byte]
constexpr std::uint16_t kSentinel = 1;

// RTPS 2.5, 9.6.3.2 and DDS Security 1.1, 7.4; above 0x8000: Fast DDS' own.
enum Parameter : std::uint16_t {
  topic_name = 0x0005,
  type_name = 0x0007,
  partition = 0x0029,
  user_data = 0x002c,
  group_data = 0x002d,
  topic_data = 0x002e,
  property_list = 0x0059,
  entity_name = 0x0062,
  key_hash = 0x0070,
  status_info = 0x0071,
  data_representation = 0x0073,
  identity_token = 0x1001,
  permissions_token = 0x1002,
  data_sharing = 0x8006,
};

// A length, then as many bytes: a string or octets.
void counted(Cursor& at) {
  at.skip(at.u32());
  at.align();
}

// A count, then elements of `least` bytes or more. Fast DDS makes room for what the count claims.
template <typename Element>
void sequence(Cursor& at, std::size_t least, const Element& element) {
  const std::uint32_t count = at.u32();
  if (count > at.left() / least) return at.skip(at.left() + 1);
  for (std::uint32_t k = 0; k < count && at.ok(); ++k) element(at);
}

void pair(Cursor& at) {
  counted(at);
  counted(at);
}

void data_holder(Cursor& at) {
  counted(at);
  sequence(at, 8, pair);  // properties
  sequence(at, 8, pair);  // binary properties
}

bool well_formed(std::uint16_t id, Cursor at) {
  switch (id) {
    case topic_name:
    case type_name:
    case entity_name:
    case user_data:
    case group_data:
    case topic_data:
      counted(at);
      break;
    case partition:
      sequence(at, 4, counted);
      break;
    case property_list:
      sequence(at, 8, pair);
      break;
    case identity_token:
    case permissions_token:
      data_holder(at);
      break;
    case data_representation:
      sequence(at, 2, [](Cursor& c) { c.skip(2); });
      break;
    case data_sharing:
      sequence(at, 8, [](Cursor& c) { c.skip(8); });
      break;
    case key_hash:
      return at.left() == kGuid;
    case status_info:
      return at.left() == 4;
    default:
      return true;
  }
  return at.ok();
}

// Up to the sentinel, and behind it.
bool well_formed_list(Cursor& at, bool little_endian) {
  while (at.ok()) {
    const std::uint16_t id = at.u16();
    const std::uint16_t length = at.u16();
    if (id == kSentinel) return at.ok();
    const Bytes value = at.take(length);
    if (length % 4 != 0 || !at.ok() || !well_formed(id, Cursor(value, little_endian))) return false;
  }
  return false;
}

bool well_formed_discovery(Bytes sample) {
  Cursor at(sample, true);
  const Bytes encapsulation = at.take(kEncapsulation);
  if (!at.ok() || encapsulation[0] != std::byte{0}) return false;
  const bool little_endian = encapsulation[1] == std::byte{3};  // PL_CDR_LE; 2: PL_CDR_BE
  if (!little_endian && encapsulation[1] != std::byte{2}) return false;
  Cursor list(at.rest(), little_endian);
  return well_formed_list(list, little_endian);
}

// Who is alive: a GUID prefix, a kind, and octets.
bool well_formed_liveliness(Bytes sample) {
  if (sample.size() < kEncapsulation) return false;
  Cursor at(sample.subspan(kEncapsulation), (sample[1] & std::byte{1}) != std::byte{0});
  at.skip(kGuid);
  counted(at);
  return at.ok();
}

// A ParticipantGenericMessage: of the handshake, or of keys.
bool well_formed_handshake(Bytes sample) {
  if (sample.size() < kEncapsulation) return false;
  Cursor at(sample.subspan(kEncapsulation), (sample[1] & std::byte{1}) != std::byte{0});
  at.skip(2 * (kGuid + 8) + 3 * kGuid);  // identities of two messages; destinations and source
  counted(at);
  sequence(at, 12, data_holder);
  return at.ok();
}

struct Builtin {
  std::uint32_t writer, reader;
  bool (*well_formed)(Bytes sample);
};
constexpr std::array<Builtin, 10> kBuiltin{{
    {0x000100c2, 0x000100c7, well_formed_discovery},  // participants
    {0x000002c2, 0x000002c7, well_formed_discovery},  // topics
    {0x000003c2, 0x000003c7, well_formed_discovery},  // publications
    {0x000004c2, 0x000004c7, well_formed_discovery},  // subscriptions
    {0xff0101c2, 0xff0101c7, well_formed_discovery},  // the same, secure
    {0xff0003c2, 0xff0003c7, well_formed_discovery},
    {0xff0004c2, 0xff0004c7, well_formed_discovery},
    {0x000200c2, 0x000200c7, well_formed_liveliness},
    {0xff0200c2, 0xff0200c7, well_formed_liveliness},
    {0x000201c3, 0x000201c4, well_formed_handshake},
}};

}  // namespace

bool is_builtin(std::uint32_t reader, std::uint32_t writer) {
  return std::ranges::any_of(
      kBuiltin, [&](const Builtin& b) { return b.reader == reader || b.writer == writer; });
}

bool well_formed_builtin_sample(std::uint32_t reader, std::uint32_t writer, Bytes payload) {
  return std::ranges::all_of(kBuiltin, [&](const Builtin& b) {
    return (b.reader != reader && b.writer != writer) || b.well_formed(payload);
  });
}

bool well_formed_inline_qos(Cursor& at) {
  return well_formed_list(at, at.little_endian());
}

}  // namespace goshawk::runtime::wire
