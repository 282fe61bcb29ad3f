// A repeated query must not allocate: operator new of this program counts.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "goshawk/path_search/path_search.hpp"
#include "reference.hpp"

namespace {
std::atomic<long> allocations{0};
}  // namespace

// Not inlined: the compiler would see malloc() against operator delete, and warn.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  ++allocations;
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace goshawk::path_search {
namespace {

TEST(PathSearch, AllocatesNothingInARepeatedQuery) {
  for (const Planner planner : {Planner::jastar, Planner::astar, Planner::astar_euclidean,
                                Planner::astar_manhattan, Planner::dijkstra}) {
    for (const Pruning pruning : {Pruning::shortest, Pruning::greedy, Pruning::none}) {
      Config config;
      config.planner = planner;
      config.pruning = pruning;
      reference::Random random(13);
      auto grid = std::make_shared<VoxelGrid>();
      grid->grown = reference::box_map({60, 60, 20}, 0.2, random);
      grid->geometry.size = grid->grown.size();
      const Vec3 start = grid->geometry.center(reference::free_voxel(grid->grown, random));
      const Vec3 goal = grid->geometry.center(reference::free_voxel(grid->grown, random));
      PathSearch search = std::move(PathSearch::create(config)).value();
      search.set_map(grid);
      PlannedPath path;
      ASSERT_TRUE(search.plan(start, goal, path).ok());
      const double length = path.pruned_length_m;
      const long before = allocations;
      ASSERT_TRUE(search.plan(start, goal, path).ok());
      EXPECT_EQ(allocations, before) << to_word(planner) << ", " << to_word(pruning);
      EXPECT_EQ(path.pruned_length_m, length);
    }
  }
}

}  // namespace
}  // namespace goshawk::path_search
