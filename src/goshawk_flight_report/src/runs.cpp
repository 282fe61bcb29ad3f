#include "runs.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace goshawk::flight_report {
namespace {

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t word = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - k);
    for (std::size_t i = 0; i < 3; ++i) {
      word = word << 8 | (i < count ? static_cast<unsigned char>(bytes[k + i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      text += i <= count ? kDigits[word >> (18 - 6 * i) & 63] : '=';
    }
  }
  return text;
}

void append_leb128(std::string& bytes, std::uint64_t value) {
  for (; value > 127; value >>= 7) bytes += static_cast<char>((value & 127) | 128);
  bytes += static_cast<char>(value);
}

}  // namespace

std::string runs_of(const BitGrid& grid) {
  std::string bytes;
  const Index3 size = grid.size();
  bool value = false;
  std::uint64_t length = 0;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      const BitGrid::Word* row = grid.row(y, z);
      for (int x = 0; x < size.x; ++x) {
        const BitGrid::Word word = row[x >> 6];
        if ((x & 63) == 0 && x + 64 <= size.x && word == (value ? ~BitGrid::Word{0} : 0)) {
          length += 64;
          x += 63;
          continue;
        }
        const bool bit = (word >> (x & 63)) & 1U;
        if (bit != value) {
          append_leb128(bytes, length);
          length = 0;
          value = bit;
        }
        ++length;
      }
    }
  }
  append_leb128(bytes, length);
  return base64(bytes);
}

}  // namespace goshawk::flight_report
