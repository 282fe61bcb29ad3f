#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/random.hpp"

// An independent truth for the search tests: shares no code with the library but BitGrid, and
// the maps that the tests search.
namespace reference {

using goshawk::BitGrid;
using goshawk::Index3;
using goshawk::Random;

/// Is the move between two neighbours allowed? Written from the rule's definition.
bool move_is_allowed(const BitGrid& blocked, Index3 from, Index3 to, bool squeeze);

/// Textbook Dijkstra from one voxel. @return the length to every voxel, x fastest, infinite where
/// there is no way
std::vector<double> distances(const BitGrid& blocked, Index3 start, bool squeeze);
/// The same for any cost of a move between neighbours, above zero.
using MoveCostOf = std::function<double(Index3 from, Index3 to)>;
std::vector<double> distances(const BitGrid& blocked, Index3 start, bool squeeze,
                              const MoveCostOf& cost);
double distance_to(const std::vector<double>& distances, Index3 size, Index3 goal);

/// Checks the moves and their sum. @return "" or what is wrong
std::string fault_of_path(const BitGrid& blocked, const std::vector<Index3>& cells, Index3 start,
                          Index3 goal, bool squeeze, double length);
std::string fault_of_path(const BitGrid& blocked, const std::vector<Index3>& cells, Index3 start,
                          Index3 goal, bool squeeze, double length, const MoveCostOf& cost);

/// Voxels drawn independently.
BitGrid noise_map(Index3 size, double ratio, Random& random);
/// Boxes and pillars until about the ratio is covered.
BitGrid box_map(Index3 size, double ratio, Random& random);
/// A size of one of many shapes: cubes, thin in one or two axes, around 64-bit word boundaries.
Index3 odd_size(Random& random);
/// A random map of a random shape, kind and density.
BitGrid any_map(Random& random);
/// A map of voxels of 0.2 m whose corner is (-1, 2, 0.5).
std::shared_ptr<goshawk::VoxelGrid> grid_of(BitGrid blocked);
/// A free voxel, or the last one drawn if the map has few.
Index3 free_voxel(const BitGrid& blocked, Random& random);

}  // namespace reference
