#include "lz4.hpp"

#include <array>
#include <bit>

#include "records.hpp"

namespace goshawk::recording {
namespace {

constexpr std::uint32_t kFrameMagic = 0x184D2204;
constexpr std::uint32_t kSkippable = 0x184D2A50;  // and the 15 values above it
constexpr std::uint32_t kStored = 0x80000000;     // a block's size: its bytes are not compressed
constexpr std::size_t kLeastMatch = 4;            // [byte]

Error damaged(std::string what) {
  return fail(ErrorCode::invalid_input, std::move(what));
}

/// The fields of a frame's head that matter.
struct FrameHead {
  bool block_checksums = false;
  bool content_checksum = false;
  bool has_size = false;
  std::uint64_t size = 0;  // [byte] of the content
};

Result<FrameHead> read_head(In& in, View packed) {
  const std::size_t begin = in.at();
  const auto flags = in.number<std::uint8_t>();
  in.number<std::uint8_t>();  // the largest block: the caller's limit counts instead
  FrameHead head;
  head.block_checksums = (flags & 0x10) != 0;
  head.content_checksum = (flags & 0x04) != 0;
  head.has_size = (flags & 0x08) != 0;
  if (head.has_size) head.size = in.number<std::uint64_t>();
  if ((flags & 0x01) != 0) return damaged("it needs an LZ4 dictionary, which MCAP does not have");
  const std::size_t end = in.at();
  const auto checksum = in.number<std::uint8_t>();
  if (!in.good()) return damaged("an LZ4 frame is cut off");
  if (flags >> 6 != 1) return damaged("its LZ4 frame is of an unknown version");
  if (std::uint8_t(xxh32(packed.subspan(begin, end - begin)) >> 8) != checksum) {
    return damaged("the head of an LZ4 frame is damaged");
  }
  return head;
}

// A length in a token's four bits goes on in bytes while those are 255.
bool extend(In& in, std::size_t& length) {
  if (length != 15) return true;
  for (std::uint8_t more = 255; more == 255;) {
    more = in.number<std::uint8_t>();
    if (!in.good()) return false;
    length += more;
  }
  return true;
}

// Repeats `length` bytes from `offset` bytes back; the two may overlap.
void repeat(Bytes& out, std::size_t offset, std::size_t length) {
  const std::size_t from = out.size() - offset;
  std::size_t to = out.size();
  out.resize(to + length);
  for (std::size_t i = from; to < out.size(); ++i, ++to) out[to] = out[i];
}

// @param begin of the frame in `out`: no match reaches before it
Status unpack_block(View block, std::size_t begin, std::size_t most, Bytes& out) {
  In in(block);
  while (in.left() > 0) {
    const auto token = in.number<std::uint8_t>();
    std::size_t literals = token >> 4;
    if (!extend(in, literals) || literals > in.left()) return damaged("an LZ4 block is cut off");
    if (literals > most - out.size()) return damaged("it holds more than it claims");
    const View bytes = in.raw(literals);
    out.insert(out.end(), bytes.begin(), bytes.end());
    if (in.left() == 0) return success();  // the last sequence has no match
    const auto offset = std::size_t(in.number<std::uint16_t>());
    std::size_t length = token & 15;
    if (!in.good() || !extend(in, length)) return damaged("an LZ4 block is cut off");
    length += kLeastMatch;
    if (offset == 0 || offset > out.size() - begin) {
      return damaged("an LZ4 block repeats bytes that do not exist");
    }
    if (length > most - out.size()) return damaged("it holds more than it claims");
    repeat(out, offset, length);
  }
  return damaged("an LZ4 block is cut off");
}

Status unpack_blocks(In& in, const FrameHead& head, std::size_t most, Bytes& out) {
  const std::size_t begin = out.size();
  while (true) {
    const auto size = in.number<std::uint32_t>();
    if (!in.good()) return damaged("an LZ4 frame is cut off");
    if (size == 0) break;
    const View block = in.raw(size & ~kStored);
    const auto checksum = head.block_checksums ? in.number<std::uint32_t>() : 0;
    if (!in.good()) return damaged("an LZ4 frame is cut off");
    if (head.block_checksums && xxh32(block) != checksum) {
      return damaged("the checksum of an LZ4 block does not match");
    }
    if ((size & kStored) == 0) {
      if (auto status = unpack_block(block, begin, most, out); !status) return status;
    } else if (block.size() > most - out.size()) {
      return damaged("it holds more than it claims");
    } else {
      out.insert(out.end(), block.begin(), block.end());
    }
  }
  const View content = View(out).subspan(begin);
  if (head.has_size && content.size() != head.size) {
    return damaged("an LZ4 frame holds other than it claims");
  }
  if (head.content_checksum && in.number<std::uint32_t>() != xxh32(content)) {
    return damaged("the checksum of an LZ4 frame does not match");
  }
  return in.good() ? success() : Status(damaged("an LZ4 frame is cut off"));
}

}  // namespace

std::uint32_t xxh32(View bytes) {
  constexpr std::uint32_t p1 = 0x9E3779B1, p2 = 0x85EBCA77, p3 = 0xC2B2AE3D, p4 = 0x27D4EB2F,
                          p5 = 0x165667B1;
  In in(bytes);
  std::uint32_t hash = p5;
  if (bytes.size() >= 16) {
    std::array<std::uint32_t, 4> lanes{p1 + p2, p2, 0, 0U - p1};
    while (in.left() >= 16) {
      for (auto& lane : lanes) {
        lane = std::rotl(lane + in.number<std::uint32_t>() * p2, 13) * p1;
      }
    }
    hash = std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) +
           std::rotl(lanes[3], 18);
  }
  hash += std::uint32_t(bytes.size());
  while (in.left() >= 4) hash = std::rotl(hash + in.number<std::uint32_t>() * p3, 17) * p4;
  while (in.left() > 0) hash = std::rotl(hash + in.number<std::uint8_t>() * p5, 11) * p1;
  hash = (hash ^ hash >> 15) * p2;
  hash = (hash ^ hash >> 13) * p3;
  return hash ^ hash >> 16;
}

Result<Bytes> unpack_lz4(View packed, std::size_t most) {
  In in(packed);
  Bytes out;
  while (in.left() > 0) {
    const auto magic = in.number<std::uint32_t>();
    if (in.good() && (magic & ~15U) == kSkippable) {
      in.raw(in.number<std::uint32_t>());
    } else if (in.good() && magic == kFrameMagic) {
      const auto head = read_head(in, packed);
      if (!head) return head.error();
      if (auto status = unpack_blocks(in, *head, most, out); !status) return status.error();
    } else {
      return damaged("its bytes are not an LZ4 frame");
    }
    if (!in.good()) return damaged("an LZ4 frame is cut off");
  }
  return out;
}

}  // namespace goshawk::recording
