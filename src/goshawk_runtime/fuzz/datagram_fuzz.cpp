// Any bytes: the check of datagrams reads none past their end, nor does what reads handshakes, and
// what is admitted is made of submessages that fill the datagram.
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "../src/wire/datagram_check.hpp"
#include "../src/wire/handshake_datagrams.hpp"

namespace {

constexpr std::size_t kHeader = 20;  // [byte]

bool submessages_fill(const std::byte* d, std::size_t size) {
  std::size_t at = kHeader;
  while (at < size) {
    if (at + 4 > size) return false;
    const auto kind = std::to_integer<unsigned>(d[at]),
               flags = std::to_integer<unsigned>(d[at + 1]);
    const auto a = std::to_integer<unsigned>(d[at + 2]), b = std::to_integer<unsigned>(d[at + 3]);
    const std::size_t length = (flags & 1U) != 0 ? a + 256 * b : 256 * a + b;
    if (length == 0 && kind != 9 && kind != 1) return true;
    at += 4 + length;
  }
  return at == size;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Mostly submessages behind a good header, sometimes anything.
  static const std::byte kGood[kHeader] = {std::byte{'R'}, std::byte{'T'}, std::byte{'P'},
                                           std::byte{'S'}, std::byte{2},   std::byte{2},
                                           std::byte{1},   std::byte{15},  std::byte{1}};
  const bool raw = size > 0 && data[0] == 'R';
  const std::size_t whole = size + (raw ? 0 : kHeader);
  const auto datagram =
      std::make_unique<std::byte[]>(whole);  // exact: the sanitizer guards its end
  if (!raw) std::memcpy(datagram.get(), kGood, kHeader);
  if (size > 0) std::memcpy(datagram.get() + (raw ? 0 : kHeader), data, size);
  namespace wire = goshawk::runtime::wire;
  const wire::Bytes all(datagram.get(), whole);
  if (!wire::admits(all)) return 0;
  if (!submessages_fill(datagram.get(), whole)) std::abort();
  const wire::SenderTable::Prefix own{};
  const bool is_both = wire::is_greeting(all, own) && wire::handshake_message(all, own);
  if (is_both) std::abort();
  return 0;
}
