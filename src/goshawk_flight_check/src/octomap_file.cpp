#include "octomap_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <sstream>

namespace goshawk::flight_check {

namespace {

constexpr int kTreeDepth = 16;  // OctoMap's keys have 16 bits

struct Header {
  std::string id;
  double resolution_m = 0.0;
  std::size_t nodes = 0;
  bool complete = false;  // the line "data" was there
};

Header read_header(std::istream& in) {
  Header header;
  for (std::string line; !header.complete && std::getline(in, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "data") header.complete = true;
    if (key == "id") words >> header.id;
    if (key == "res") words >> header.resolution_m;
    if (key == "size") words >> header.nodes;
  }
  return header;
}

/// OctoMap's reader trusts the bits it gets and reads past the end of the file. So the shape of the
/// tree is checked first: every node is there, and none is deeper than keys reach.
class ShapeCheck {
 public:
  explicit ShapeCheck(std::string_view data) : data_(data) {}

  /// @return whether a .bt node (two bits a child, 11: an inner node follows) is complete
  bool binary_node(int depth) {
    if (depth >= kTreeDepth || data_.size() - at_ < 2) return false;
    int inner = 0;
    for (int byte = 0; byte < 2; ++byte) {
      const unsigned bits = static_cast<unsigned char>(data_[at_++]);
      for (unsigned child = 0; child < 4; ++child) {
        const unsigned kind = bits >> (2 * child) & 3U;
        nodes_ += kind != 0;
        inner += kind == 3;
      }
    }
    while (inner > 0 && binary_node(depth + 1)) --inner;
    return inner == 0;
  }

  /// @return whether a .ot node (float log odds, one bit a child) is whole
  bool full_node(int depth) {
    if (depth > kTreeDepth || data_.size() - at_ < 5) return false;
    at_ += 4;
    int children = std::popcount(static_cast<unsigned char>(data_[at_++]));
    nodes_ += std::size_t(children);
    while (children > 0 && full_node(depth + 1)) --children;
    return children == 0;
  }

  std::size_t nodes() const { return nodes_; }

 private:
  std::string_view data_;
  std::size_t at_ = 0;
  std::size_t nodes_ = 1;
};

Error malformed(const std::filesystem::path& file, const std::string& what) {
  return fail(ErrorCode::map_malformed,
              fmt::format("'{}' is not a complete OctoMap file: {}; create or download it again",
                          file.string(), what));
}

Status check_header(const std::filesystem::path& file, const Header& header) {
  if (!header.complete) return malformed(file, "its header has no line 'data'");
  if (header.id != "OcTree") {
    return malformed(file,
                     "it holds a tree of kind '" + header.id + "', and only OcTree is supported");
  }
  if (!(header.resolution_m > 0.0) || !std::isfinite(header.resolution_m)) {
    return malformed(file, "its resolution is not above zero");
  }
  if (header.nodes == 0) {
    return fail(ErrorCode::map_empty,
                "'" + file.string() + "' holds no voxel: create the map again");
  }
  return success();
}

}  // namespace

Result<std::unique_ptr<octomap::OcTree>> read_octomap(const std::filesystem::path& file) {
  const auto ending = file.extension();
  if (ending != ".bt" && ending != ".ot") {
    return fail(ErrorCode::map_unreadable, "'" + file.string() +
                                               "' does not end in .bt or .ot: convert it to an "
                                               "OctoMap first");
  }
  std::ifstream in(file, std::ios::binary);
  std::error_code ignored;
  if (!in || std::filesystem::is_directory(file, ignored)) {
    return fail(ErrorCode::map_unreadable,
                "cannot open the map '" + file.string() + "': check the path and its permissions");
  }
  const Header header = read_header(in);
  if (auto status = check_header(file, header); !status) return status.error();
  std::ostringstream rest;
  rest << in.rdbuf();
  const std::string data = std::move(rest).str();

  ShapeCheck shape(data);
  const bool binary = ending == ".bt";
  if (!(binary ? shape.binary_node(0) : shape.full_node(0))) {
    return malformed(file, "its tree is truncated or too deep");
  }
  if (shape.nodes() != header.nodes) {
    return malformed(
        file, fmt::format("its header promises {} nodes, it has {}", header.nodes, shape.nodes()));
  }
  auto tree = std::make_unique<octomap::OcTree>(header.resolution_m);
  std::istringstream nodes(data);
  if (binary) {
    tree->readBinaryData(nodes);
  } else {
    tree->readData(nodes);
  }
  return tree;
}

Result<std::unique_ptr<octomap::OcTree>> read_payload(std::string_view payload,
                                                      double resolution_m) {
  if (!(resolution_m > 0.0) || !std::isfinite(resolution_m)) {
    return fail(ErrorCode::map_malformed, "the OctoMap message's resolution is not above zero");
  }
  if (payload.empty()) {
    return fail(ErrorCode::map_empty, "the OctoMap message holds no voxel");
  }
  if (ShapeCheck shape(payload); !shape.binary_node(0)) {
    return fail(ErrorCode::map_malformed,
                "the OctoMap message's tree is truncated or too deep: is it binary?");
  }
  auto tree = std::make_unique<octomap::OcTree>(resolution_m);
  std::istringstream nodes{std::string(payload)};
  tree->readBinaryData(nodes);
  return tree;
}

namespace {

void occupy_gaps(octomap::OcTree& tree, octomap::OcTreeNode* node) {
  const bool leaf = !tree.nodeHasChildren(node);
  if (leaf) return;
  for (unsigned child = 0; child < 8; ++child) {
    if (tree.nodeChildExists(node, child)) {
      occupy_gaps(tree, tree.getNodeChild(node, child));
    } else {
      tree.createNodeChild(node, child)->setLogOdds(tree.getClampingThresMaxLog());
    }
  }
}

}  // namespace

void occupy_unknown(octomap::OcTree& tree) {
  if (tree.getRoot() != nullptr) occupy_gaps(tree, tree.getRoot());
}

}  // namespace goshawk::flight_check
