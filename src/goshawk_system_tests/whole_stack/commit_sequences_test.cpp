#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "goshawk/core/random.hpp"
#include "goshawk/worlds/world.hpp"
#include "whole_stack.hpp"

// The margin of the map covers the tracking error for every sequence of commits, also if goals
// come faster than any of them can be reached, from any side.

namespace goshawk::whole_stack {
namespace {

constexpr double kFlight_s = 8.0;

int sequences_or(int usual) {
  const char* wish = std::getenv("GOSHAWK_SEQUENCES");
  return wish == nullptr ? usual : std::max(1, std::atoi(wish));
}

World wide_world(std::uint64_t seed) {
  worlds::WorldSpec spec;
  spec.size_m = Vec3(12.0, 12.0, 5.0);
  spec.density = 0.02;
  spec.seed = seed;
  auto made = worlds::make_world(spec);
  EXPECT_TRUE(made) << made.error().message;
  return {made->geometry, made->occupied};
}

/// Goals for one flight: by turns on two sides of it, at an even pace or a random one.
class Goals {
 public:
  Goals(World& world, Random& random) : world_(world), random_(random) {
    alternates_ = random.chance(0.5);
    pace_s_ = random.uniform(0.1, 1.0);
    first_ = world.free_place(random);
    second_ = world.free_place(random);
  }
  Vec3 next() {
    side_ = !side_;
    if (alternates_) return side_ ? first_ : second_;
    return world_.free_place(random_);
  }
  double wait_s() { return alternates_ ? pace_s_ : random_.uniform(0.05, 1.5); }

 private:
  World& world_;
  Random& random_;
  bool alternates_ = false;
  double pace_s_ = 0.5;
  bool side_ = false;
  Vec3 first_, second_;
};

TEST(CommitSequences, KeepTheTrackingErrorBelowTheMargin) {
  double worst_m = 0.0;
  int commits = 0, switches_lost = 0;
  const int sequences = sequences_or(40);
  for (int seed = 1; seed <= sequences; ++seed) {
    SCOPED_TRACE(seed);
    World world = wide_world(std::uint64_t(seed) + 100);
    Random random{std::uint64_t(seed)};
    Stack stack(world, world.free_place(random), std::uint64_t(seed));
    Goals goals(world, random);
    while (stack.now_ns() < std::int64_t(kFlight_s * 1e9)) {
      stack.go_to(goals.next());
      stack.run(goals.wait_s());
    }
    for (const Error& fault : stack.faults) {
      switches_lost += fault.code == ErrorCode::tracking_lost ? 1 : 0;
    }
    EXPECT_LT(stack.max_error_m, kMargin_m);
    worst_m = std::max(worst_m, stack.max_error_m);
    commits += stack.commits;
  }
  std::printf("%d sequences, %d commits, largest tracking error %.4f m\n", sequences, commits,
              worst_m);
  EXPECT_EQ(switches_lost, 0);
  EXPECT_GT(commits, 4 * sequences);
}

}  // namespace
}  // namespace goshawk::whole_stack
