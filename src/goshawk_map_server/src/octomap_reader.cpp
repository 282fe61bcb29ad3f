// OctoMap's own readers take what a stream gives after its end for data, recurse as deep as the
// file says, and report on stderr. So the bytes are walked here first; only a file that is whole
// and sound reaches them.

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <cstring>
#include <optional>

#include "readers.hpp"
#include "text.hpp"

namespace goshawk::map_server {
namespace {

constexpr int kTreeDepth = 16;

struct Header {
  std::string kind;  // of tree
  std::uint64_t nodes = 0;
  double resolution_m = 0.0;
  std::string_view payload;
};

// "id OcTree", "size N", "res R" and comments in any order after the first line, then "data".
Result<Header> read_header(std::string_view bytes, std::string_view first_line) {
  TextReader reader(bytes);
  const std::string_view first = reader.line();
  if (first.substr(0, first_line.size()) != first_line) {
    return malformed("the first line is not '" + std::string(first_line) +
                     "': it is no OctoMap file of this kind (OctoMap's convert_octree mends "
                     "outdated ones)");
  }
  Header header;
  std::optional<std::uint64_t> nodes;
  std::optional<double> resolution;
  while (!reader.done()) {
    const auto words = split(reader.line());
    if (words.empty() || words[0].front() == '#') continue;
    if (words[0] == "data") {
      header.payload = reader.rest();
      if (!nodes || !resolution || header.kind.empty()) {
        return malformed("the header lacks one of 'id', 'size' and 'res'");
      }
      header.nodes = *nodes;
      header.resolution_m = *resolution;
      return header;
    }
    if (words.size() < 2) continue;
    if (words[0] == "id") header.kind = words[1];
    if (words[0] == "size") nodes = parse<std::uint64_t>(words[1]);
    if (words[0] == "res") resolution = parse<double>(words[1]);
  }
  return malformed("the header has no 'data' line: the file is truncated");
}

Status check_resolution(double resolution_m) {
  // Below a micrometre and above a kilometre the bytes are damaged, and keys lose their meaning.
  if (resolution_m >= 1e-6 && resolution_m <= 1e3) return success();
  return malformed(
      fmt::format("its resolution is {} m: from 1e-6 to 1e3 m can be read", resolution_m));
}

Status check_header(const Header& header) {
  if (auto status = check_resolution(header.resolution_m); !status) return status;
  if (header.nodes == 0) return fail(ErrorCode::map_empty, "the tree has no node");
  return success();
}

// Walks a tree's bytes; `Format::node` reads one node and gives its children.
template <typename Format>
class Walker {
 public:
  explicit Walker(std::string_view bytes, Format format) : bytes_(bytes), format_(format) {}

  /// @param expected_nodes what the header says, if there is a header
  Status run(std::optional<std::uint64_t> expected_nodes) {
    const char* fault = walk(0);
    if (fault != nullptr) return malformed(fault);
    if (at_ != bytes_.size()) {
      return malformed(fmt::format("{} bytes are left after the tree", bytes_.size() - at_));
    }
    if (expected_nodes && nodes_ != *expected_nodes) {
      return malformed(
          fmt::format("the header promises {} nodes, the tree has {}", *expected_nodes, nodes_));
    }
    if (nodes_ == 1) return fail(ErrorCode::map_empty, "the tree is only a root");
    return success();
  }

  Format& format() { return format_; }

 private:
  const char* walk(int depth) {
    ++nodes_;
    if (bytes_.size() - at_ < format_.node_bytes()) return "the tree is truncated";
    unsigned inner = 0;  // children that are walked next
    if (const char* fault = format_.node(bytes_.substr(at_, format_.node_bytes()), inner, nodes_)) {
      return fault;
    }
    at_ += format_.node_bytes();
    if (inner != 0 && depth >= kTreeDepth - format_.leaf_levels_in_parent()) {
      return "the tree is deeper than OctoMap's 16 levels";
    }
    for (unsigned i = 0; i < 8; ++i) {
      if ((inner >> i & 1U) == 0) continue;
      if (const char* fault = walk(depth + 1)) return fault;
    }
    return nullptr;
  }

  std::string_view bytes_;
  Format format_;
  std::size_t at_ = 0;
  std::uint64_t nodes_ = 0;
};

// .bt: two bits a child; leaves are not nodes of their own in the bytes.
struct BinaryFormat {
  std::size_t node_bytes() const { return 2; }
  int leaf_levels_in_parent() const { return 1; }
  const char* node(std::string_view bytes, unsigned& inner, std::uint64_t& nodes) const {
    const unsigned children = std::uint8_t(bytes[0]) | unsigned(std::uint8_t(bytes[1])) << 8;
    if (children == 0 && nodes > 1) return "an inner node has no children";
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned content = children >> (2 * i) & 3U;
      if (content == 3) inner |= 1U << i;
      if (content == 1 || content == 2) ++nodes;  // leaves
    }
    return nullptr;
  }
};

// .ot: log-odds (and colour) of each node, then a byte that names its children.
struct FullFormat {
  std::size_t colour_bytes = 0;
  std::string without_colours = {};
  std::size_t node_bytes() const { return sizeof(float) + colour_bytes + 1; }
  int leaf_levels_in_parent() const { return 0; }
  const char* node(std::string_view bytes, unsigned& inner, std::uint64_t&) {
    float log_odds = 0.0F;
    std::memcpy(&log_odds, bytes.data(), sizeof log_odds);
    // NaN compares as "not occupied": it must not turn an obstacle into free space.
    if (!std::isfinite(log_odds)) return "a node's occupancy is not a number";
    inner = std::uint8_t(bytes.back());
    if (colour_bytes > 0) {
      without_colours.append(bytes.substr(0, sizeof log_odds));
      without_colours.push_back(bytes.back());
    }
    return nullptr;
  }
};

Result<OcTreePtr> read_nodes(std::string_view payload, double resolution_m,
                             std::optional<std::uint64_t> expected_nodes) {
  Walker walker(payload, BinaryFormat{});
  if (auto status = walker.run(expected_nodes); !status) return status.error();
  auto tree = std::make_shared<octomap::OcTree>(resolution_m);
  MemoryStream stream(payload);
  tree->readBinaryData(stream);
  return tree;
}

}  // namespace

Result<OcTreePtr> read_bt(std::string_view bytes) {
  const auto header = read_header(bytes, "# Octomap OcTree binary file");
  if (!header) return header.error();
  if (auto status = check_header(*header); !status) return status.error();
  if (header->kind != "OcTree" && header->kind != "ColorOcTree") {
    return malformed("it holds a tree of kind '" + header->kind + "': only OcTree is read");
  }
  return read_nodes(header->payload, header->resolution_m, header->nodes);
}

Result<OcTreePtr> read_binary_payload(std::string_view payload, double resolution_m) {
  if (auto status = check_resolution(resolution_m); !status) return status.error();
  if (payload.empty()) return fail(ErrorCode::map_empty, "the tree has no node");
  return read_nodes(payload, resolution_m, {});
}

Result<OcTreePtr> read_ot(std::string_view bytes) {
  const auto header = read_header(bytes, "# Octomap OcTree file");
  if (!header) return header.error();
  if (auto status = check_header(*header); !status) return status.error();
  const bool coloured = header->kind == "ColorOcTree";
  if (header->kind != "OcTree" && !coloured) {
    return malformed("it holds a tree of kind '" + header->kind +
                     "': only OcTree and ColorOcTree are read");
  }
  Walker walker(header->payload, FullFormat{coloured ? std::size_t{3} : std::size_t{0}});
  if (auto status = walker.run(header->nodes); !status) return status.error();

  auto tree = std::make_shared<octomap::OcTree>(header->resolution_m);
  MemoryStream stream(coloured ? std::string_view(walker.format().without_colours)
                               : header->payload);
  tree->readData(stream);
  return tree;
}

}  // namespace goshawk::map_server
