// A repeated query must not allocate: operator new and malloc of this program count.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "support/worlds.hpp"

namespace {
std::atomic<long> allocations{0};
}  // namespace

// Eigen takes its memory from malloc.
extern "C" void* __libc_malloc(std::size_t bytes);
extern "C" [[gnu::noinline]] void* malloc(std::size_t bytes) {
  ++allocations;
  return __libc_malloc(bytes);
}

namespace goshawk::corridor_builder {
namespace {

TEST(CorridorBuilder, AllocatesNothingInARepeatedQuery) {
  for (const Config& config :
       {Config{}, Config{.generator = Generator::box}, Config{.margin = Margin::sphere},
        Config{.expansion_passes = 2, .max_faces = 8}, Config{.bend_path = false}}) {
    CorridorBuilder builder = std::move(CorridorBuilder::create(config)).value();
    VoxelGrid grid = test_support::boxes_and_pillars({30, 40, 20}, 0.2, 0.4, 0.2, 7);
    grid.raw = grid.grown;  // as if nothing had been inflated
    Random random(41);
    Corridor corridor;
    int queries = 0;
    for (int k = 0; k < 20; ++k) {
      const auto path = test_support::random_free_path(grid, 4, 4.0, random);
      if (path.empty()) continue;
      // Twice: pieces of working memory change places, and each grows when it is first needed.
      ASSERT_TRUE(builder.build(grid, path, corridor).ok());
      ASSERT_TRUE(builder.build(grid, path, corridor).ok());
      const long before = allocations;
      ASSERT_TRUE(builder.build(grid, path, corridor).ok());
      EXPECT_EQ(allocations, before) << to_word(config.generator) << ", " << to_word(config.margin);
      ++queries;
    }
    EXPECT_GT(queries, 10);
  }
  const long before = allocations;
  std::vector<int>* volatile kept = new std::vector<int>(100);
  delete kept;
  EXPECT_GT(allocations, before);  // it does count
}

}  // namespace
}  // namespace goshawk::corridor_builder
