// Scans of a place that is known must not allocate: operator new of this program counts.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>

#include "goshawk/core/random.hpp"
#include "goshawk/map_server/live_map.hpp"

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

namespace goshawk::map_server {
namespace {

TEST(LiveMap, AllocatesNothingWhileItSeesWhatItKnows) {
  for (const auto policy : {UnknownPolicy::occupied, UnknownPolicy::blocked, UnknownPolicy::free}) {
    Random random(3);
    LiveMap map =
        LiveMap::unknown_space({Vec3(-8, -8, -2), Vec3(8, 8, 4)}, 0.2, {policy, 0.3}).value();
    std::vector<std::vector<Vec3>> scans(8);
    for (auto& points : scans) {
      for (int i = 0; i < 500; ++i) {
        points.push_back(
            Vec3(random.uniform(-7, 7), random.uniform(-7, 7), random.uniform(-1.5, 3.5)));
      }
    }
    ScanResult result;
    const auto fly = [&](int rounds) {
      for (int k = 0; k < rounds * 8; ++k) {
        const Vec3 from(0.3 * std::sin(0.7 * k), 0.3 * std::cos(0.7 * k), 0.1);
        const Scan scan{.points_map = scans[std::size_t(k % 8)],
                        .origins_map = {&from, 1},
                        .max_range_m = 6.0,
                        .body_path_map = {&from, 1},
                        .body_radius_m = 0.3};
        ASSERT_TRUE(map.insert_scan(scan, result));
      }
    };
    fly(40);
    const long before = allocations;
    fly(40);
    EXPECT_EQ(allocations, before);
    EXPECT_FALSE(result.update.bricks.empty());
  }
}

}  // namespace
}  // namespace goshawk::map_server
