#include "lz4.hpp"

#include <gtest/gtest.h>

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

/// A frame of one block, with every checksum, as a compressor that chooses at random would write
/// it.
struct RandomFrame {
  explicit RandomFrame(Random& random) {
    Bytes block;
    for (int n = random.below(40); n > 0; --n) sequence(random, block, false);
    sequence(random, block, true);
    Out o(packed);
    o.number(std::uint32_t{0x184D2204});
    const Bytes head{0x54, 0x70};  // version 1, checksums of blocks and content; blocks of 4 MiB
    o.raw(head).number(std::uint8_t(xxh32(head) >> 8));
    o.number(std::uint32_t(block.size())).raw(block).number(xxh32(block));
    o.number(std::uint32_t{0}).number(xxh32(content));
  }
  Bytes packed, content;

 private:
  static void length(Bytes& block, std::size_t value) {
    if (value < 15) return;
    for (value -= 15; value >= 255; value -= 255) block.push_back(255);
    block.push_back((unsigned char)(value));
  }
  void sequence(Random& random, Bytes& block, bool last) {
    const auto literals = std::size_t(random.below(random.chance(0.2) ? 700 : 20));
    const bool match = !last && content.size() + literals > 0;
    const auto repeated = std::size_t(random.below(random.chance(0.2) ? 900 : 20));
    block.push_back((unsigned char)(std::min<std::size_t>(literals, 15) << 4 |
                                    (match ? std::min<std::size_t>(repeated, 15) : 0)));
    length(block, literals);
    for (std::size_t i = 0; i < literals; ++i) {
      block.push_back((unsigned char)(random.below(256)));
      content.push_back(block.back());
    }
    if (last) return;
    if (!match) {
      block.pop_back();
      return;
    }
    const auto offset =
        std::size_t(1 + random.below(int(std::min<std::size_t>(content.size(), 65535))));
    block.push_back((unsigned char)(offset & 255));
    block.push_back((unsigned char)(offset >> 8));
    length(block, repeated);
    for (std::size_t i = 0; i < repeated + 4; ++i) {
      content.push_back(content[content.size() - offset]);
    }
  }
};

TEST(Lz4, UnpacksWhatTheReferenceProgramPacked) {
  EXPECT_EQ(text_of(unpack_lz4(from_hex(kPacked), 1000)), kText);
}

TEST(Lz4, UnpacksFramesOfAnyLengthsAndMatches) {
  Random random(11);
  for (int trial = 0; trial < 500; ++trial) {
    const RandomFrame frame(random);
    const auto content = unpack_lz4(frame.packed, frame.content.size());
    ASSERT_TRUE(content) << content.error().message;
    ASSERT_EQ(*content, frame.content);
    if (!frame.content.empty()) {
      EXPECT_FALSE(unpack_lz4(frame.packed, frame.content.size() - 1));
    }
  }
}

TEST(Lz4, UnpacksFramesInARowStoredBlocksAndSkipsOthers) {
  Bytes bytes;
  Out o(bytes);
  o.number(std::uint32_t{0x184D2A53}).number(std::uint32_t{3}).raw(Bytes{1, 2, 3});
  o.raw(from_hex(kPacked));
  const Bytes head{0x60, 0x40};
  o.number(std::uint32_t{0x184D2204}).raw(head).number(std::uint8_t(xxh32(head) >> 8));
  o.number(std::uint32_t{0x80000002}).raw(Bytes{'h', 'i'}).number(std::uint32_t{0});
  EXPECT_EQ(text_of(unpack_lz4(bytes, 1000)), kText + "hi");
}

TEST(Lz4, DamageIsFoundAndNeverCrashes) {
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
