#include "datagram_check.hpp"

#include <algorithm>
#include <array>

#include "parameter_check.hpp"
#include "submessage.hpp"

namespace goshawk::runtime::wire {
namespace {

constexpr std::uint32_t kMostNumbers = 256;  // in a set: 8.3.5.5
constexpr std::uint32_t kMostFragments = 1U << 20;
constexpr std::string_view kNoFault;

bool zero(Bytes bytes) {
  return std::ranges::all_of(bytes, [](std::byte b) { return b == std::byte{0}; });
}

bool counts(std::int64_t number) {
  return number >= 1 && number < kMostSequence;
}

// Base, count of bits, bits. @return whether all of its numbers are such
bool number_set(Cursor& at, std::int64_t base, std::int64_t most) {
  const std::uint32_t bits = at.u32();
  if (bits > kMostNumbers) return false;
  at.skip((bits + 31) / 32 * 4);
  return at.ok() && base >= 0 && base + bits <= most;
}

std::string_view fault_of_acknack(Cursor at) {
  at.skip(8);  // reader, writer
  const std::int64_t base = at.sequence_number();
  const bool set = number_set(at, base, kMostSequence);
  at.skip(4);  // count
  return set && at.ok() ? kNoFault : "an ACKNACK's set of numbers is malformed";
}

std::string_view fault_of_heartbeat(Cursor at) {
  at.skip(8);
  const std::int64_t first = at.sequence_number(), last = at.sequence_number();
  at.skip(4);
  const bool range = counts(first) && last >= first - 1 && last < kMostSequence;
  return range && at.ok() ? kNoFault : "a HEARTBEAT's range of numbers is malformed";
}

std::string_view fault_of_gap(Cursor at) {
  at.skip(8);
  const std::int64_t first = at.sequence_number(), base = at.sequence_number();
  const bool set = number_set(at, base, kMostSequence);
  if (!set || !at.ok() || !counts(first) || base < first) return "a GAP is malformed";
  return base - first <= kMostGap ? kNoFault : "a GAP skips too many samples";
}

std::string_view fault_of_nack_fragments(Cursor at) {
  at.skip(8);
  const std::int64_t number = at.sequence_number();
  const std::int64_t base = at.u32();
  const bool set = number_set(at, base, kMostFragments);
  at.skip(4);
  const bool good = set && at.ok() && counts(number) && base >= 1;
  return good ? kNoFault : "a NACK_FRAG's set of fragments is malformed";
}

/// What DATA and DATA_FRAG begin with.
struct Sample {
  std::uint32_t reader = 0, writer = 0;
  std::size_t to_inline_qos = 0;  // [byte] from behind this field
  bool good = false;
};

Sample begin_sample(Cursor& at, std::size_t fixed) {
  Sample s;
  at.skip(2);  // flags for extensions
  s.to_inline_qos = at.u16();
  s.reader = at.entity();
  s.writer = at.entity();
  s.good = counts(at.sequence_number()) && s.writer != 0 && at.ok() && s.to_inline_qos >= fixed &&
           s.to_inline_qos % 4 == 0;
  return s;
}

// @return whether the payload begins where the cursor now is
bool go_to_payload(const Submessage& of, const Sample& s, Cursor& at) {
  at.skip(4 + s.to_inline_qos - at.at());
  return at.ok() && (!of.has(1) || well_formed_inline_qos(at));
}

std::string_view fault_of_data(const Submessage& of) {
  Cursor at = of.cursor();
  const Sample s = begin_sample(at, 16);
  if (!s.good || !go_to_payload(of, s, at)) return "a DATA is malformed";
  const bool has_data = of.has(2), has_key = of.has(3);
  if (has_data && has_key) return "a DATA has both data and a key";
  if ((has_data || has_key) && at.left() == 0) return "a DATA has an empty payload";
  if (has_data && !well_formed_builtin_sample(s.reader, s.writer, at.rest())) {
    return "discovery data is malformed";
  }
  return kNoFault;
}

std::string_view fault_of_data_fragments(const Submessage& of) {
  Cursor at = of.cursor();
  const Sample s = begin_sample(at, 28);
  const std::uint64_t first = at.u32(), count = at.u16(), size = at.u16(), whole = at.u32();
  if (!s.good || !go_to_payload(of, s, at)) return "a DATA_FRAG is malformed";
  if (of.has(2)) return "a DATA_FRAG carries a key";
  if (is_builtin(s.reader, s.writer)) return "discovery data comes in fragments";
  if (whole > kMostSample) return "a DATA_FRAG is of a message that is too large";
  if (size < 4 || size % 4 != 0 || whole == 0) return "a DATA_FRAG's sizes are malformed";
  const std::uint64_t fragments = (whole + size - 1) / size;
  if (fragments > kMostFragments) return "a DATA_FRAG is of too many fragments";
  if (first < 1 || count < 1 || first + count - 1 > fragments) {
    return "a DATA_FRAG numbers fragments that its message does not have";
  }
  const std::uint64_t here = std::min(count * size, whole - (first - 1) * size);
  return at.left() >= here ? kNoFault : "a DATA_FRAG lacks bytes of its fragments";
}

std::string_view fault_of_secure_body(Cursor at) {
  // Always big-endian, whatever the flag says.
  Cursor length(at.rest(), false);
  length.skip(length.u32());
  return length.ok() ? kNoFault : "an encrypted body is longer than its submessage";
}

std::string_view fault_of_secure_postfix(Cursor at) {
  constexpr std::size_t kCode = 16, kOneReader = 20;
  Cursor tag(at.rest(), false);
  tag.skip(kCode);
  const std::uint32_t readers = tag.u32();
  const bool good = tag.ok() && readers <= tag.left() / kOneReader;
  return good ? kNoFault : "a signature is malformed";
}

std::string_view least(const Submessage& of, std::size_t size) {
  return of.body.size() >= size ? kNoFault : "a submessage is too short for its kind";
}

std::string_view fault_of_submessage(const Submessage& of) {
  switch (of.kind) {
    case acknack:
      return fault_of_acknack(of.cursor());
    case heartbeat:
      return fault_of_heartbeat(of.cursor());
    case gap:
      return fault_of_gap(of.cursor());
    case nack_fragments:
      return fault_of_nack_fragments(of.cursor());
    case heartbeat_fragments:
      return least(of, 24);
    case data:
      return fault_of_data(of);
    case data_fragments:
      return fault_of_data_fragments(of);
    case info_time:
      return least(of, of.has(1) ? 0 : 8);
    case info_destination:
      return least(of, kPrefix);
    case info_source:
      return of.body.size() == 20 ? kNoFault : "an INFO_SRC has a wrong length";
    case secure_body:
      return fault_of_secure_body(of.cursor());
    case secure_prefix:
    case secure_message_prefix:
      return of.body.size() == 20 ? kNoFault : "a security header has a wrong length";
    case secure_postfix:
    case secure_message_postfix:
      return fault_of_secure_postfix(of.cursor());
    default:
      return kNoFault;
  }
}

}  // namespace

std::string_view fault_of(Bytes datagram) noexcept {
  constexpr std::array kBegin{std::byte{'R'}, std::byte{'T'}, std::byte{'P'}, std::byte{'S'},
                              std::byte{2}};
  if (datagram.size() < kHeader || !std::ranges::equal(datagram.first(kBegin.size()), kBegin)) {
    return "it does not begin with a header of RTPS 2";
  }
  const Bytes sender = datagram.subspan(kHeader - kPrefix, kPrefix);
  if (zero(sender)) return "its header names no sender";
  const bool of_eprosima = datagram[6] == std::byte{1} && datagram[7] == std::byte{15};

  Cursor at(datagram.subspan(kHeader), false);
  while (at.left() > 0) {
    Submessage of;
    if (!next(at, of)) return "a submessage extends past the end";
    // Fast DDS' statistics, which it asserts to be the last.
    if (of.kind >= first_of_vendor && of_eprosima && !of.last) {
      return "a submessage of Fast DDS' own is not the last";
    }
    if (const auto fault = fault_of_submessage(of); !fault.empty()) return fault;
    // Only gateways speak for others, and forgers.
    if (of.kind == info_source && !std::ranges::equal(of.body.last(kPrefix), sender)) {
      return "an INFO_SRC names another sender";
    }
  }
  return kNoFault;
}

}  // namespace goshawk::runtime::wire
