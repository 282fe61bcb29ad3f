#pragma once

#include "goshawk/path_search/path_search.hpp"

namespace goshawk::cli {

struct Tour {
  Vec3 start_map = Vec3::Zero();
  std::vector<Vec3> goals_map;
};

/// `count` random goals, each reachable from the one before: free voxels of the grown map, drawn
/// evenly, at least min_distance_m apart, joined by a path that the search found.
/// @return no_path if too few such points were found
Result<Tour> random_tour(const std::shared_ptr<const VoxelGrid>& grid,
                         path_search::PathSearch& search, int count, std::uint64_t seed,
                         double min_distance_m);

}  // namespace goshawk::cli
