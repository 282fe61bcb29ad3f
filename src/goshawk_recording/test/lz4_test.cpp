#include "lz4.hpp"

#include <gtest/gtest.h>
#include <lz4frame.h>

#include <string>

#include "goshawk/core/random.hpp"
#include "memory_sink.hpp"
#include "records.hpp"

namespace goshawk::recording {
namespace {

Bytes from_hex(const std::string& hex) {
  Bytes bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back((unsigned char)(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

std::string text_of(const Result<Bytes>& bytes) {
  return bytes ? std::string(bytes->begin(), bytes->end()) : "failed: " + bytes.error().message;
}

// printf '%s' "$TEXT" | lz4 -9 -BX | xxd -p, by lz4 1.9.4
const std::string kText =
    "goshawk goshawk goshawk goshawk, 0123456789012345678901234567890123456789";
const std::string kPacked =
    "04224d187440bd220000008f676f736861776b20080004cf2c20303132333435363738390a00065035363738395861"
    "e5560000000097db0bae";

Bytes pack(const Bytes& content) {
  Bytes packed(LZ4F_compressFrameBound(content.size(), nullptr));
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), content.data(), content.size(), nullptr));
  return packed;
}

// Runs of bytes of random lengths.
Bytes random_content(Random& random) {
  Bytes content;
  for (int n = random.below(60); n > 0; --n) {
    const auto byte = (unsigned char)(random.below(4));
    content.insert(content.end(), std::size_t(random.below(random.chance(0.1) ? 90'000 : 90)),
                   byte);
  }
  return content;
}

TEST(Lz4, UnpacksWhatTheReferenceProgramPacked) {
  EXPECT_EQ(text_of(unpack_lz4(from_hex(kPacked), 1000)), kText);
}

TEST(Lz4, UnpacksContentOfAnySizeUpToWhatIsAllowed) {
  Random random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const Bytes whole = random_content(random);
    const Bytes packed = pack(whole);
    const auto content = unpack_lz4(packed, whole.size());
    ASSERT_TRUE(content) << content.error().message;
    ASSERT_EQ(*content, whole);
    if (whole.empty()) continue;
    const auto more = unpack_lz4(packed, whole.size() - 1);
    ASSERT_FALSE(more);
    EXPECT_EQ(more.error().message, "it holds more than it claims");
  }
}

TEST(Lz4, UnpacksFramesInARowAndSkipsOthers) {
  Bytes bytes;
  Out o(bytes);
  o.number(std::uint32_t{0x184D2A53}).number(std::uint32_t{3}).raw(Bytes{1, 2, 3});
  o.raw(from_hex(kPacked)).raw(pack(Bytes{'h', 'i'}));
  EXPECT_EQ(text_of(unpack_lz4(bytes, 1000)), kText + "hi");
}

TEST(Lz4, DamageIsFound) {
  Random random(12);
  const Bytes whole = from_hex(kPacked);
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_FALSE(unpack_lz4(View(whole).first(size), 1000)) << size;
  }
  for (int trial = 0; trial < 20'000; ++trial) {
    Bytes bytes = whole;
    const auto at = std::size_t(random.below(int(bytes.size())));
    bytes[at] ^= (unsigned char)(1 << random.below(8));
    EXPECT_FALSE(unpack_lz4(bytes, 1000)) << "byte " << at;
  }
}

}  // namespace
}  // namespace goshawk::recording
