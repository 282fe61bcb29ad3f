#include "flight/random_tour.hpp"

#include <fmt/format.h>

#include "goshawk/core/random.hpp"

namespace goshawk::cli {
namespace {

constexpr int kTriesPerPoint = 20'000;

}  // namespace

Result<Tour> random_tour(const std::shared_ptr<const VoxelGrid>& grid,
                         path_search::PathSearch& search, int count, std::uint64_t seed,
                         double min_distance_m) {
  Random random(seed);
  search.set_map(grid);
  const Index3 size = grid->geometry.size;
  const auto draw = [&] {
    Index3 i;
    do {
      i = {random.below(size.x), random.below(size.y), random.below(size.z)};
    } while (grid->grown.get(i));
    return grid->geometry.center(i);
  };
  if (grid->grown.count() == grid->grown.voxels()) {
    return fail(ErrorCode::map_empty, "the map has no free voxel to fly in");
  }
  // A first point in a small closed pocket leads nowhere: others are tried.
  for (int attempt = 0; attempt < 20; ++attempt) {
    Tour tour{draw(), {}};
    Vec3 at = tour.start_map;
    for (int tries = 0; tries < kTriesPerPoint && int(tour.goals_map.size()) < count; ++tries) {
      const Vec3 goal = draw();
      if ((goal - at).norm() < min_distance_m) continue;
      if (!search.plan(at, goal)) {
        if (tour.goals_map.empty() && tries > 20) break;
        continue;
      }
      tour.goals_map.push_back(goal);
      at = goal;
    }
    if (int(tour.goals_map.size()) == count) return tour;
  }
  return fail(ErrorCode::no_path,
              fmt::format("found no {} reachable goals at least {:g} m apart: is the map large and "
                          "open enough for this radius and margin?",
                          count, min_distance_m));
}

}  // namespace goshawk::cli
