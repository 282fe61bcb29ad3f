#include "bt_encoder.hpp"

#include <bit>
#include <cstdint>
#include <optional>

namespace goshawk::map_server {
namespace {

// What two bits of the file say of a child.
enum Content : unsigned { unknown = 0, free_space = 1, occupied_space = 2, mixed = 3 };

class BtEncoder {
 public:
  BtEncoder(Index3 lower_key, const BitGrid& occupied, const BitGrid& known)
      : lower_(lower_key),
        upper_(lower_key + occupied.size()),
        occupied_(occupied),
        known_(known) {}

  std::string run() {
    // The root has no parent to say what it is: a uniform one is written by its children.
    const Content root = encode({0, 0, 0}, 16);
    if (root == free_space || root == occupied_space) append(0x5555U * unsigned(root));
    return std::move(bytes_);
  }

 private:
  Content encode(Index3 key, int level) {
    const int side = 1 << level;
    if (key.x >= upper_.x || key.y >= upper_.y || key.z >= upper_.z || key.x + side <= lower_.x ||
        key.y + side <= lower_.y || key.z + side <= lower_.z) {
      return unknown;
    }
    if (level == 0) return voxel(key - lower_);
    // Looking at rows of bits is many times faster than at voxels; most of a map is uniform.
    if (level == 5 || level == 3) {
      if (const auto content = uniform(key - lower_, side)) return *content;
    }

    const std::size_t at = bytes_.size();
    append(0);
    unsigned children = 0;
    const int half = side / 2;
    for (int i = 0; i < 8; ++i) {
      const Index3 child{key.x + (i & 1 ? half : 0), key.y + (i & 2 ? half : 0),
                         key.z + (i & 4 ? half : 0)};
      children |= unsigned(encode(child, level - 1)) << (2 * i);
    }
    // All eight the same and none of them mixed: one leaf says it.
    const unsigned first = children & 3U;
    if (first != mixed && children == 0x5555U * first) {
      bytes_.resize(at);
      return Content(first);
    }
    bytes_[at] = char(children & 0xFFU);
    bytes_[at + 1] = char(children >> 8);
    return mixed;
  }

  Content voxel(Index3 i) const {
    if (!known_.empty() && !known_.get(i)) return unknown;
    return occupied_.get(i) ? occupied_space : free_space;
  }

  // What all voxels of a block are, or nothing if they differ or some lie outside the grid.
  std::optional<Content> uniform(Index3 at, int side) const {
    const Index3 last{at.x + side - 1, at.y + side - 1, at.z + side - 1};
    if (!occupied_.contains(at) || !occupied_.contains(last)) return {};
    const Content content = voxel(at);
    const BitGrid::Word ones = (BitGrid::Word{1} << side) - 1;
    const BitGrid::Word known = content == unknown ? 0 : ones;
    const BitGrid::Word occupied = content == occupied_space ? ones : 0;
    for (int z = at.z; z <= last.z; ++z) {
      for (int y = at.y; y <= last.y; ++y) {
        if (!known_.empty() && (run(known_.row(y, z), at.x, side) & ones) != known) return {};
        if (content == unknown) continue;  // what is not known is not occupied either
        if ((run(occupied_.row(y, z), at.x, side) & ones) != occupied) return {};
      }
    }
    return content;
  }

  // The bits from x on; those beyond `length` mean nothing.
  static BitGrid::Word run(const BitGrid::Word* row, int x, int length) {
    const BitGrid::Word low = row[x >> 6] >> (x & 63);
    if ((x & 63) + length <= 64) return low;
    return low | row[(x >> 6) + 1] << (64 - (x & 63));
  }

  void append(unsigned children) {
    bytes_.push_back(char(children & 0xFFU));
    bytes_.push_back(char(children >> 8));
  }

  Index3 lower_;
  Index3 upper_;
  const BitGrid& occupied_;
  const BitGrid& known_;
  std::string bytes_;
};

}  // namespace

std::string encode_bt(Index3 lower_key, const BitGrid& occupied, const BitGrid& known) {
  return BtEncoder(lower_key, occupied, known).run();
}

std::uint64_t count_nodes(std::string_view payload) {
  std::uint64_t nodes = payload.size() / 2;
  for (const char byte : payload) {
    // Pairs of bits that differ are leaves.
    nodes += std::uint64_t(std::popcount((unsigned(byte) ^ unsigned(byte) >> 1) & 0x55U));
  }
  return nodes;
}

}  // namespace goshawk::map_server
