#include "mutator.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace goshawk::hostile {
namespace {

constexpr int kMostChanges = 4;
// What counts, lengths and numbers are compared with: limits, and one more or less.
constexpr std::array<std::uint32_t, 16> kNumbers{
    0,      1,      2,      3,         255,         256,       257,         0x7fff,
    0x8000, 0xffff, 0x1000, 1U << 20U, 0x7fffffffU, 1U << 31U, 0xfffffffeU, 0xffffffffU};
constexpr std::array<std::uint8_t, 24> kKinds{0x01, 0x06, 0x07, 0x08, 0x09, 0x0c, 0x0d, 0x0e,
                                              0x0f, 0x12, 0x13, 0x15, 0x16, 0x30, 0x31, 0x32,
                                              0x33, 0x34, 0x80, 0x81, 0xff, 0x00, 0x7f, 0x90};

// Where submessages begin, as far as they can be told.
std::vector<std::size_t> submessages(const Bytes& d) {
  std::vector<std::size_t> found;
  std::size_t at = kHeader;
  while (at + 4 <= d.size()) {
    found.push_back(at);
    const auto low = std::to_integer<std::size_t>(d[at + 2]);
    const auto high = std::to_integer<std::size_t>(d[at + 3]);
    const bool little = (std::to_integer<unsigned>(d[at + 1]) & 1U) != 0;
    at += 4 + (little ? low + 256 * high : high + 256 * low);
  }
  return found;
}

}  // namespace

Bytes Mutator::operator()(std::span<const Bytes> good) {
  Bytes datagram = good[below(good.size())];
  if (random_.chance(0.1)) return datagram;
  for (int k = 1 + random_.below(kMostChanges); k > 0; --k) change(datagram, good);
  return datagram;
}

void Mutator::change(Bytes& d, std::span<const Bytes> good) {
  if (d.empty()) return;
  switch (random_.below(6)) {
    case 0:
      d[below(d.size())] ^= std::byte(1U << below(8));
      break;
    case 1:
      d[below(d.size())] = std::byte(below(256));
      break;
    case 2:
      d.resize(below(d.size() + 1));
      break;
    case 3:
      d.resize(d.size() + below(64), std::byte(below(256)));
      break;
    case 4:
      change_number(d);
      break;
    default:
      change_submessages(d, good);
  }
}

void Mutator::change_number(Bytes& d) {
  const std::size_t size = random_.chance(0.5) ? 2 : 4;
  if (d.size() < kHeader + size) return;
  const std::size_t at = kHeader + below((d.size() - kHeader - size) / 2 + 1) * 2;
  const std::uint32_t number = kNumbers[below(kNumbers.size())];
  const bool little = random_.chance(0.8);
  for (std::size_t k = 0; k < size; ++k) {
    d[at + (little ? k : size - 1 - k)] = std::byte(number >> 8 * k);
  }
}

void Mutator::change_submessages(Bytes& d, std::span<const Bytes> good) {
  const auto begins = submessages(d);
  if (begins.empty()) return;
  const std::size_t which = below(begins.size());
  const auto begin = d.begin() + std::ptrdiff_t(begins[which]);
  const auto end =
      which + 1 < begins.size() ? d.begin() + std::ptrdiff_t(begins[which + 1]) : d.end();
  const Bytes other = good[below(good.size())];
  switch (random_.below(5)) {
    case 0:
      *begin = std::byte(kKinds[below(kKinds.size())]);
      break;
    case 1:
      *(begin + 1) ^= std::byte(1U << below(8));  // a flag
      break;
    case 2: {
      const Bytes twice(begin, end);
      d.insert(begin, twice.begin(), twice.end());
      break;
    }
    case 3:
      d.erase(begin, end);
      break;
    default:
      if (other.size() > kHeader) d.insert(begin, other.begin() + kHeader, other.end());
  }
}

bool carries_sample(const Bytes& d) {
  constexpr std::size_t kWriterEnds = 15;  // [byte] behind the beginning of a DATA
  return std::ranges::any_of(submessages(d), [&](std::size_t at) {
    const bool data = d[at] == std::byte{0x15} || d[at] == std::byte{0x16};
    // The last byte of a built-in endpoint's id has both upper bits.
    return data && at + kWriterEnds < d.size() && d[at + kWriterEnds] < std::byte{0xc0};
  });
}

void replace_name(Bytes& datagram, std::span<const std::byte> from, std::span<const std::byte> to) {
  auto at = datagram.begin();
  while (true) {
    at = std::search(at, datagram.end(), from.begin(), from.end());
    if (at == datagram.end()) return;
    at = std::ranges::copy(to, at).out;
  }
}

}  // namespace goshawk::hostile
