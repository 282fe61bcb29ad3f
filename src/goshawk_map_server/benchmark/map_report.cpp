// goshawk_map_report FILE [INFLATION_M]: what a map costs to load, voxelize and grow, and what
// each policy for unknown space leaves of the space that was measured free.

#include <octomap/OcTree.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace {

using namespace goshawk;
using namespace goshawk::map_server;

class Stopwatch {
 public:
  double lap_s() {
    const auto now = Clock::now();
    const double lap = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return lap;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024.0;
}

// Marks the piece of free space around `from` in `seen`. @return its voxels
std::int64_t flood(const BitGrid& blocked, Index3 from, BitGrid& seen) {
  std::vector<Index3> open{from};
  seen.set(from, true);
  std::int64_t count = 0;
  while (!open.empty()) {
    const Index3 at = open.back();
    open.pop_back();
    ++count;
    for (const Index3 step :
         {Index3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      const Index3 next = at + step;
      if (blocked.test(next) || seen.get(next)) continue;
      seen.set(next, true);
      open.push_back(next);
    }
  }
  return count;
}

struct Pieces {
  std::int64_t measured_free = 0;  // free voxels that were measured
  std::int64_t free = 0;           // free voxels
  std::int64_t largest = 0;        // of the largest piece (steps over faces)
};

Pieces pieces_of(const VoxelGrid& grid) {
  Pieces pieces;
  BitGrid seen(grid.geometry.size, false);
  const Index3 n = grid.geometry.size;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const Index3 at{x, y, z};
        if (grid.grown.get(at)) continue;
        ++pieces.free;
        pieces.measured_free += grid.known.get(at) ? 1 : 0;
        if (!seen.get(at))
          pieces.largest = std::max(pieces.largest, flood(grid.grown, at, seen));
      }
    }
  }
  return pieces;
}

int report(const std::string& path, double inflation_m) {
  Stopwatch watch;
  const auto source = load_map(path);
  if (!source) {
    std::fprintf(stderr, "%s\n", source.error().message.c_str());
    return 1;
  }
  const double load_s = watch.lap_s();
  const double load_mb = peak_mb();
  const auto raw = voxelize(*source);
  if (!raw) {
    std::fprintf(stderr, "%s\n", raw.error().message.c_str());
    return 1;
  }
  const double voxelize_s = watch.lap_s();
  const double layer_mb = double(raw->occupied.to_words().size() * sizeof(BitGrid::Word)) / 1048576.0;
  const std::int64_t occupied = raw->occupied.count();
  const std::int64_t free = raw->known.count() - occupied;
  std::printf("%s: %s voxels of %g m, %lld occupied, %lld free, one layer %.2f MB\n", path.c_str(),
              to_text(raw->geometry.size).c_str(), raw->geometry.resolution_m,
              static_cast<long long>(occupied), static_cast<long long>(free), layer_mb);
  std::printf("load %.3f s, voxelize %.3f s, peak %.1f MB after loading\n", load_s, voxelize_s,
              load_mb);
  for (const auto policy : {UnknownPolicy::occupied, UnknownPolicy::blocked, UnknownPolicy::free}) {
    watch.lap_s();
    const auto grid = make_voxel_grid(*raw, {policy, inflation_m}, 1);
    const double grow_s = watch.lap_s();
    const std::string name(to_word(policy));
    if (!grid) {
      std::printf("unknown %-8s: %s\n", name.c_str(), grid.error().message.c_str());
      continue;
    }
    const double grow_mb = peak_mb();
    const Pieces pieces = pieces_of(*grid);
    std::printf(
        "unknown %-8s: %5.1f %% of the measured free space stays, %5.1f %% of all that is "
        "free in one piece; grown in %.3f s, peak %.1f MB\n",
        name.c_str(), 100.0 * double(pieces.measured_free) / double(free),
        100.0 * double(pieces.largest) / double(pieces.free), grow_s, grow_mb);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: goshawk_map_report FILE [INFLATION_M]\n");
    return 2;
  }
  return report(argv[1], argc > 2 ? std::atof(argv[2]) : 0.2);
}
