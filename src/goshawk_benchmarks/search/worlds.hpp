#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "goshawk/core/bit_grid.hpp"

namespace worlds {

using goshawk::BitGrid;
using goshawk::Index3;

/// A map and the pairs of voxels to search between.
struct World {
  std::string name;
  BitGrid blocked;
  struct Query {
    Index3 start;
    Index3 goal;
  };
  std::vector<Query> queries;
  /// Draws what cuts the goal off, if anything does.
  void (*cut_off)(BitGrid& map) = nullptr;
};

/// Voxels drawn independently; from one corner to the opposite one, both kept free.
World noise(Index3 size, double ratio, std::uint64_t seed);

/// Boxes and pillars, grown by one voxel, until the ratio of the grown map is reached; between
/// free voxels near opposite corners.
World boxes(Index3 size, double ratio, std::uint64_t seed);

/// Rooms of 5 x 5 m at 0.2 m with a door in each wall and a window here and there.
World office(Index3 size, std::uint64_t seed);

/// Trunks and crowns of goshawk_worlds, grown by 0.2 m; between opposite corners.
World forest(Index3 size, double ratio, std::uint64_t seed);

/// A Warframe map with as many of its problems, spread over the file. @return a world without
/// queries if the files of that name are missing
World warframe(const std::string& name, std::size_t problems);

/// A Warframe map with those of its problems whose paths are longest beside the empty grid's.
World warframe_hard(const std::string& name, std::size_t problems);

/// The same map with a wall of two voxels across the middle of x, from end to end.
World walled(World world);

/// The same map with a closed room of 100 x 60 x 30 voxels in its middle, and the goal in it.
/// @pre the map is larger than the room
World with_closed_room(World world);

/// An OctoMap file of the data folder, unknown space blocked, grown by 0.2 m, with random pairs of
/// voxels that are joined. @return a world without queries if the file is missing
World octomap(const std::string& name, std::size_t queries);

/// The folder with maps of the world: GOSHAWK_DATA, or ../shared/data.
std::string data_folder();

}  // namespace worlds
