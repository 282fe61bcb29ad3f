#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "goshawk/core/bit_grid.hpp"

namespace goshawk::map_server {

/// The payload of a .bt file (OctoMap's depth-first binary form: two bytes a node, two bits a
/// child) that says what the bits say. Built from the voxels up, so that uniform regions become
/// one leaf without a tree of single voxels in between.
/// @param lower_key OctoMap key of voxel (0, 0, 0) @param known empty: all voxels are known
/// @return empty if nothing is known
std::string encode_bt(Index3 lower_key, const BitGrid& occupied, const BitGrid& known);

/// @return nodes of the tree that a payload describes, leaves included: the header's "size"
std::uint64_t count_nodes(std::string_view payload);

}  // namespace goshawk::map_server
