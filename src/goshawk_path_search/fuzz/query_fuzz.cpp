// Any map, any configuration, any points: a code and a sentence, or a path that keeps its promises.
#include <cmath>
#include <cstring>
#include <limits>

#include "goshawk/core/line_of_sight.hpp"
#include "goshawk/path_search/path_search.hpp"

namespace {

using namespace goshawk;
using namespace goshawk::path_search;

/// Reads numbers from the fuzzer's bytes; zeros when they are used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  std::uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  /// Mostly a place in a small map, sometimes any bits at all, NaN and infinity among them.
  double number() {
    const std::uint8_t kind = byte();
    if (kind < 250) return kind / 25.0 - 1.0;
    std::uint8_t raw[8];
    for (auto& b : raw) b = byte();
    double value;
    std::memcpy(&value, raw, sizeof value);
    return value;
  }
  Vec3 point() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

Config read_config(Bytes& in) {
  static const char* kBoxes[] = {"", "0,0,0,1,1,1", "-1,-1,-1,9,9,9", "1,2", "nan,0,0,1,1,1"};
  Config c;
  const std::uint8_t flags = in.byte();
  c.planner = Planner(in.byte() % 5);
  c.corner_rule = (flags & 1U) != 0 ? CornerRule::squeeze : CornerRule::no_squeeze;
  c.pruning = (flags & 2U) != 0 ? Pruning::greedy : Pruning::relaxed;
  c.nearest_reachable = (flags & 4U) != 0;
  if ((flags & 8U) != 0) c.move_within_m = in.number();
  if ((flags & 16U) != 0) c.z_weight = in.number();
  if ((flags & 32U) != 0) c.clearance_m = in.number();
  if ((flags & 64U) != 0) c.unknown = UnknownRule(in.byte() % 4);
  if ((flags & 128U) != 0) c.search_box = kBoxes[in.byte() % 5];
  return c;
}

std::shared_ptr<VoxelGrid> read_map(Bytes& in) {
  auto grid = std::make_shared<VoxelGrid>();
  const Index3 size{1 + in.byte() % 70, 1 + in.byte() % 9, 1 + in.byte() % 9};
  grid->geometry = {Vec3::Zero(), in.number(), size};
  const std::uint8_t flags = in.byte();
  if ((flags & 1U) != 0) grid->geometry.resolution_m = 0.2;
  if ((flags & 2U) != 0) grid->geometry.size.x += 1;  // one that does not agree with its bits
  grid->unknown_is_occupied = (flags & 4U) != 0;
  grid->grown = BitGrid(size, true);
  if ((flags & 8U) != 0) grid->known = BitGrid(size, false, true);
  std::uint32_t state = in.byte() + 1U;
  const std::uint32_t ratio = in.byte();
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        state = state * 1664525U + 1013904223U;
        if (state >> 24 < ratio) grid->grown.set({x, y, z}, true);
        if (!grid->known.empty() && (state >> 8 & 7U) == 0) grid->known.set({x, y, z}, false);
      }
    }
  }
  return grid;
}

void expect(bool holds) {
  if (!holds) __builtin_trap();
}

void check_path(const VoxelGrid& map, const Config& config, const PlannedPath& path) {
  expect(path.waypoints_map.size() >= 2 && path.raw_map.size() >= 2);
  expect(path.pruned_length_m <= path.raw_length_m * (1.0 + 1e-9));
  expect(std::isfinite(path.cost) && path.cost >= 0.0);
  if (config.corner_rule == CornerRule::squeeze) return;
  for (std::size_t i = 1; i < path.waypoints_map.size(); ++i) {
    expect(line_is_free(map, path.waypoints_map[i - 1], path.waypoints_map[i]));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  const Config config = read_config(in);
  auto search = PathSearch::create(config);
  if (!search) {
    expect(!search.error().message.empty());
    return 0;
  }
  const auto map = read_map(in);
  search->set_map(map);
  const Vec3 start = in.point();
  std::vector<Vec3> goals(in.byte() % 4);
  for (Vec3& goal : goals) goal = in.point();
  const auto path = search->plan({.start_map = start, .goals_map = goals});
  if (path) {
    check_path(*map, config, *path);
  } else {
    expect(!path.error().message.empty() && path.code() != ErrorCode::ok);
  }
  return 0;
}
