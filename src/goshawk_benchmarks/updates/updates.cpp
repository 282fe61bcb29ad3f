// goshawk bench updates: what an update of a large map costs each stage that follows it.
#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>

#include "common/measure.hpp"
#include "common/report.hpp"
#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/grid.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/tracker/tracker.hpp"

namespace goshawk::bench {
namespace {

using Map = std::shared_ptr<const VoxelGrid>;
constexpr Index3 kSize{500, 500, 100};  // 25 million voxels
constexpr int kChanged = 1000;          // voxels that an update changes

/// Boxes over a tenth of a known world.
VoxelGrid make_map(Random& random) {
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.1, kSize};
  grid.grown = BitGrid(kSize, true);
  grid.known = BitGrid(kSize, false, true);
  grid.inflation_m = 0.2;
  for (int n = 0; n < 700; ++n) {
    const Index3 at{30 + random.below(kSize.x - 50), random.below(kSize.y - 20), random.below(80)};
    for (int z = at.z; z < at.z + 20; ++z) {
      for (int y = at.y; y < at.y + 10; ++y) grid.grown.set_run(at.x, at.x + 20, y, z, true);
    }
  }
  grid.raw = grid.grown;
  return grid;
}

Index3 random_voxel(Random& random) {
  return {random.below(kSize.x), random.below(kSize.y), random.below(kSize.z)};
}

/// Voxels of a cube somewhere, as a scan of something near changes them, or anywhere.
std::vector<Index3> voxels_to_change(bool scattered, Random& random) {
  std::vector<Index3> voxels;
  const Index3 corner{random.below(kSize.x - 10), random.below(kSize.y - 10), random.below(90)};
  for (int k = 0; k < kChanged; ++k) {
    voxels.push_back(scattered ? random_voxel(random)
                               : corner + Index3{k % 10, k / 10 % 10, k / 100});
  }
  return voxels;
}

/// What brings the map to one in which these voxels are the other way round.
GridUpdate make_update(const VoxelGrid& map, std::span<const Index3> voxels) {
  VoxelGrid changed = map;
  BitGrid marked(brick_counts(kSize), false);
  GridUpdate update{map.version, map.version + 1, {}, {}};
  for (const Index3 i : voxels) {
    changed.grown.set(i, !map.grown.get(i));
    changed.raw.set(i, !map.raw.get(i));
    marked.set({i.x / Brick::kSizeX, i.y / Brick::kSizeY, i.z / Brick::kSizeZ}, true);
  }
  const Index3 n = marked.size();
  for (int k = 0; k < n.x * n.y * n.z; ++k) {
    const Index3 brick{k % n.x, k / n.x % n.y, k / n.x / n.y};
    if (marked.get(brick)) update.bricks.push_back(brick_of(changed, brick));
  }
  return update;
}

/// A stage that has the map and takes the next version of it.
struct Follower {
  std::string name;
  std::function<void(const Map&)> follow;
  std::function<void()> prepare = [] {};  // before each update, not timed
  std::vector<double> us = {};
};

path_search::PathSearch search_of(const path_search::Config& config) {
  return std::move(path_search::PathSearch::create(config)).value();
}

/// In flight, at the beginning of 48 m beside all boxes in 48 pieces.
tracker::Tracker flying_tracker() {
  Trajectory trajectory;
  const auto knot = [](int k) {
    return FlatState{.position = Vec3(1.55, 1.05 + k, 5.05),
                     .velocity = Vec3(0.0, k == 0 || k == 48 ? 0.0 : 1.0, 0.0)};
  };
  for (int k = 0; k < 48; ++k) {
    const bool is_at_rest = k == 0 || k == 47;  // at one end
    trajectory.pieces.push_back(BezierPiece::between(knot(k), knot(k + 1), is_at_rest ? 2.0 : 1.0));
  }
  auto certified = certify(std::move(trajectory), {Polytope::box(Vec3::Zero(), Vec3::Constant(50))},
                           {.v_max_m_s = 5.0, .a_max_m_s2 = 9.0}, knot(0), knot(48));
  auto committed = CommittedTrajectory::make({.id = 1, .nominal = std::move(certified).value()});
  tracker::Config config;
  config.require_map = false;
  auto tracker = tracker::Tracker::create(config).value();
  const RigidBodyState vehicle{.position_map = knot(0).position};
  if (!tracker.step(vehicle, 0) || !tracker.accept(std::move(committed).value(), 0) ||
      !tracker.step(vehicle, 4'000'000)) {
    throw std::logic_error("the benchmark's trajectory was refused");
  }
  return tracker;
}

/// Turns of all followers; what a turn takes is the processor time of this thread.
class Run {
 public:
  explicit Run(Random& random)
      : random_(random), map_(std::make_shared<const VoxelGrid>(make_map(random))) {
    path_search::Config search;
    add_search("path_search", search);
    search.search_box = "5,5,1,45,45,9";
    add_search("path_search, search_box", search);
    search.search_box.clear();
    search.clearance_m = 0.5;
    add_search("path_search, clearance_m 0.5", search);
    add_corridors("corridor_builder and a corridor, grown_grid", {});
    add_corridors("corridor_builder and a corridor, sphere",
                  {.margin = corridor_builder::Margin::sphere});
    add_tracker();
    for (Follower& f : followers_) f.follow(map_);
  }

  void measure(Report& report, bool scattered, int updates) {
    report.progress(scattered ? "voxels anywhere" : "voxels of a cube");
    std::vector<double> taken_us, bricks;
    for (Follower& f : followers_) f.us.clear();
    for (int n = 0; n < updates; ++n) {
      const auto update = make_update(*map_, voxels_to_change(scattered, random_));
      goshawk_msgs::msg::VoxelGridUpdate m;
      m.header(conversions::make_header(0));
      conversions::fill_msg(update, m);
      bricks.push_back(double(update.bricks.size()));
      taken_us.push_back(time_us([&] { map_ = take(m); }, Clock::processor));
      for (Follower& f : followers_) {
        f.prepare();
        f.us.push_back(time_us([&] { f.follow(map_); }, Clock::processor));
      }
    }
    add_row(report, scattered, "map subscription", taken_us, median(bricks));
    for (const Follower& f : followers_) add_row(report, scattered, f.name, f.us, median(bricks));
  }

 private:
  // As MapSubscription does.
  Map take(const goshawk_msgs::msg::VoxelGridUpdate& m) const {
    const auto update = conversions::from_msg(m);
    VoxelGrid grid = *map_;
    if (!update || !apply(grid, *update)) throw std::runtime_error("the update does not fit");
    return std::make_shared<const VoxelGrid>(std::move(grid));
  }

  void add_search(const std::string& name, const path_search::Config& config) {
    auto search = std::make_shared<path_search::PathSearch>(search_of(config));
    followers_.push_back({name, [search](const Map& map) { search->set_map(map); }});
  }

  void add_corridors(const std::string& name, const corridor_builder::Config& config) {
    auto builder = std::make_shared<corridor_builder::CorridorBuilder>(
        std::move(corridor_builder::CorridorBuilder::create(config)).value());
    auto corridor = std::make_shared<Corridor>();
    followers_.push_back({name, [=](const Map& map) {
                            const std::vector<Vec3> path{{0.5, 0.5, 9.5}, {1.5, 0.5, 9.5}};
                            (void)builder->build(*map, path, *corridor).ok();
                          }});
  }

  void add_tracker() {
    const auto tracker = std::make_shared<tracker::Tracker>(flying_tracker());
    followers_.push_back(
        {.name = "tracker, 48 m of flight",
         .follow = [tracker](const Map& map) { tracker->set_map(map, 8'000'000); },
         .prepare = [tracker, flying = flying_tracker()] { *tracker = flying; }});
  }

  static void add_row(Report& report, bool scattered, const std::string& stage,
                      const std::vector<double>& us, double bricks) {
    std::vector<double> sorted = us;
    std::ranges::sort(sorted);
    report.add({{"table", "updates"},
                {"voxels", std::int64_t{kSize.x} * kSize.y * kSize.z},
                {"changed", kChanged},
                {"where", scattered ? "anywhere" : "a cube"},
                {"bricks", bricks},
                {"stage", stage},
                {"median_us", at_share(sorted, 0.5)},
                {"p99_us", at_share(sorted, 0.99)}});
  }

  Random& random_;
  Map map_;
  std::vector<Follower> followers_;
};

void run(Report& report) {
  Random random(1);
  Run updates(random);
  for (const bool scattered : {false, true}) {
    updates.measure(report, scattered, report.options().quick ? 30 : 200);
  }
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "updates", goshawk::bench::run);
}
