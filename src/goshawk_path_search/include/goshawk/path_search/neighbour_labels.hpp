#pragma once

#include "goshawk/path_search/labels.hpp"
#include "goshawk/path_search/obstacle_bits.hpp"

namespace goshawk::path_search {

/// The neighbours of a node whose labels a single move from it would improve, blocked ones
/// included; without a branch for each. Labels only get better: a move that is left out now never
/// improves one. The same holds for a jump whose first voxel is left out: what lies behind that
/// voxel is reached from it, as cheaply (docs/search.md).
/// @pre the node has a label of this query
BlockMask improved_neighbours(const LabelTable& labels, const ObstacleBits& bits,
                              ObstacleBits::Node node);

}  // namespace goshawk::path_search
