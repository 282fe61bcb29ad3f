// goshawk bench senses: what becomes of what sensors see in the live map. Thin things, false
// returns of rain and dust, and floors that rays graze; simulated sensors, exact poses.
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "common/report.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/sensors/sensor.hpp"
#include "goshawk/sensors/solid_world.hpp"

namespace goshawk::bench {
namespace {

using namespace goshawk::sensors;
using map_server::LiveMap;

constexpr std::int64_t kPose_ns = 4'000'000;  // between poses: odometry at 250 Hz
constexpr std::int64_t kBegin_ns = 1'000'000'000;
constexpr double kVoxel_m = 0.2;
constexpr double kInflation_m = 0.2;
constexpr double kSettle_s = 1.0;  // before anything is counted

using Flight = std::function<Pose(double t_s)>;

/// Hovers at a place, sways by 5 cm and turns to and fro by 3 degrees, as vehicles do.
Flight hover(const Vec3& place_map) {
  return [=](double t) -> Pose {
    return {place_map + 0.05 * Vec3(std::sin(2.0 * t), std::cos(3.0 * t), std::sin(1.3 * t)),
            Quaternion(Eigen::AngleAxisd(0.05 * std::sin(0.9 * t), Vec3::UnitZ()))};
  };
}

SolidWorld world_of(std::vector<Solid> solids) {
  auto world = SolidWorld::create(std::move(solids));
  if (!world) throw std::runtime_error(world.error().message);
  return *std::move(world);
}

LiveMap map_of(const map_server::Box& box, const map_server::LiveOptions& options) {
  auto map = LiveMap::unknown_space(box, kVoxel_m, {map_server::UnknownPolicy::free, kInflation_m},
                                    options);
  if (!map) throw std::runtime_error(map.error().message);
  return *std::move(map);
}

map_server::LiveOptions options_of(int hits_needed) {
  map_server::LiveOptions options;
  options.odds = map_server::OddsModel::make(hits_needed, 4).value();
  return options;
}

/// Points where they were measured: a perfect registration, so that only the sensor errs.
void place(const Scan& scan, const Flight& flight, const Pose& mount, std::vector<Vec3>& points,
           std::vector<Vec3>& origins) {
  points.clear();
  origins.clear();
  for (const Return& r : scan.returns) {
    if (!r.valid) continue;
    const Pose body = flight(1e-9 * double(scan.start_ns + r.offset_ns - kBegin_ns));
    const auto to_map = [&](const Vec3& p) -> Vec3 {
      return body.q_map_base * (mount.q_map_base * p + mount.position_map) + body.position_map;
    };
    points.push_back(to_map(r.point.cast<double>()));
    origins.push_back(to_map(Vec3::Zero()));
  }
}

/// @param seen called after each scan, with its end [s]
void fly(const SensorParameters& parameters, const World& world, const Flight& flight,
         double time_s, LiveMap& map, const std::function<void(double)>& seen) {
  auto sensor = Sensor::create(parameters);
  if (!sensor) throw std::runtime_error(sensor.error().message);
  PoseTrack track;
  std::vector<Vec3> points, origins;
  map_server::ScanResult result;
  Status status = success();
  const auto done = [&](const Scan& scan) {
    place(scan, flight, sensor->mount(), points, origins);
    if (points.empty()) return;
    status = map.insert_scan({.points_map = points, .origins_map = origins}, result);
    if (status) seen(1e-9 * double(scan.end_ns - kBegin_ns));
  };
  for (std::int64_t at_ns = 0; double(at_ns) <= 1e9 * time_s && status; at_ns += kPose_ns) {
    status = track.add(kBegin_ns + at_ns, flight(1e-9 * double(at_ns)));
    if (status) status = sensor->advance(world, track, done);
  }
  if (!status) throw std::runtime_error(status.error().message);
}

SensorParameters preset_of(Preset preset) {
  SensorParameters parameters;
  apply_preset(preset, parameters);
  return parameters;
}

/// Is an obstacle in the voxel of a point, or in one beside it?
bool near_raw(const VoxelGrid& grid, const Vec3& p) {
  const auto at = grid.geometry.index_of(p);
  if (!at) return false;
  for (int k = 0; k < 27; ++k) {
    const Index3 v = *at + Index3{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    if (grid.raw.contains(v) && grid.raw.get(v)) return true;
  }
  return false;
}

/// A thing of which these points must be in the map.
struct Thing {
  std::string name;
  Solid solid;
  std::vector<Vec3> points;  // one in each of its voxels
};

constexpr double kEyes_m = 2.1;  // height of the sensor

/// Upright, 3 cm thick; the part that every preset has in view.
Thing pole(double range_m) {
  Thing thing{"pole, 3 cm", Solid::cylinder(Vec3(range_m, 0.3, 0.0), 0.015, 6.0), {}};
  const double height_m = std::clamp(0.2 * range_m, kVoxel_m, 1.5);
  for (double z = kEyes_m; z < kEyes_m + height_m; z += kVoxel_m) {
    thing.points.push_back(Vec3(range_m, 0.3, z));
  }
  return thing;
}

/// Level and across the view, 5 mm thick, a little above the sensor.
Thing wire(double range_m) {
  const double z = kEyes_m + 0.1 * range_m;
  const double end_m = std::min(0.5 * range_m, 3.0);
  Thing thing{"wire, 5 mm",
              Solid::box(Vec3(range_m - 0.0025, -end_m, z - 0.0025),
                         Vec3(range_m + 0.0025, 0.0, z + 0.0025)),
              {}};
  for (double y = -0.1; y > -end_m; y -= kVoxel_m) thing.points.push_back(Vec3(range_m, y, z));
  return thing;
}

/// The share of a thing's voxels that are in the map, averaged over the scans of 3 s. A wall stands
/// far behind it: rays that miss the thing say that its voxels are free.
double kept_share(Preset preset, const Thing& thing) {
  const SolidWorld world =
      world_of({thing.solid, Solid::box(Vec3(28.0, -30.0, -5.0), Vec3(28.5, 30.0, 20.0))});
  LiveMap map = map_of({Vec3(-1.0, -8.0, 0.0), Vec3(27.0, 8.0, 7.0)}, options_of(2));
  double sum = 0.0;
  int scans = 0;
  fly(preset_of(preset), world, hover(Vec3(0.0, 0.0, kEyes_m - 0.1)), 4.0, map, [&](double t) {
    if (t < kSettle_s) return;
    const VoxelGrid grid = map.grid();
    const auto kept =
        std::ranges::count_if(thing.points, [&](const Vec3& p) { return near_raw(grid, p); });
    sum += double(kept) / double(thing.points.size());
    ++scans;
  });
  return sum / std::max(scans, 1);
}

void measure_thin(Report& report, Preset preset, const std::vector<double>& ranges_m) {
  for (const double range_m : ranges_m) {
    for (const Thing& thing : {pole(range_m), wire(range_m)}) {
      report.add({{"table", "thin"},
                  {"preset", std::string(to_word(preset))},
                  {"thing", thing.name},
                  {"range_m", range_m},
                  {"kept_share", kept_share(preset, thing)}});
    }
  }
}

// A room of 24 x 16 x 6 m. Its faces lie in the middle of voxels.
constexpr double kRoomX_m = 12.1, kRoomY_m = 8.1, kFloor_m = -0.1, kCeiling_m = 5.9;

SolidWorld room() {
  const double far_m = 20.0;
  return world_of({Solid::box(Vec3(-far_m, -far_m, kFloor_m - 1.0), Vec3(far_m, far_m, kFloor_m)),
                   Solid::box(Vec3(-far_m, -far_m, kCeiling_m), Vec3(far_m, far_m, kCeiling_m + 1)),
                   Solid::box(Vec3(-far_m, -far_m, 0), Vec3(-kRoomX_m, far_m, kCeiling_m)),
                   Solid::box(Vec3(kRoomX_m, -far_m, 0), Vec3(far_m, far_m, kCeiling_m)),
                   Solid::box(Vec3(-far_m, -far_m, 0), Vec3(far_m, -kRoomY_m, kCeiling_m)),
                   Solid::box(Vec3(-far_m, kRoomY_m, 0), Vec3(far_m, far_m, kCeiling_m))});
}

const map_server::Box kRoomBox{Vec3(-13.0, -9.0, -1.0), Vec3(13.0, 9.0, 7.0)};

/// Obstacles of the map that stand free in the room, and the share of the space ahead that is
/// blocked for the vehicle's centre; means over the scans.
struct Ghosts {
  double voxels = 0.0, blocked_share = 0.0;
};

Ghosts ghosts_in(const VoxelGrid& grid) {
  const Vec3 lower(-kRoomX_m + 0.5, -kRoomY_m + 0.5, kFloor_m + 0.5);
  const Vec3 upper(kRoomX_m - 0.5, kRoomY_m - 0.5, kCeiling_m - 0.5);
  const map_server::Box inside{lower, upper}, ahead{Vec3(1.0, -2.0, 1.0), Vec3(6.0, 2.0, 3.0)};
  Ghosts ghosts;
  int voxels_ahead = 0;
  const Index3 n = grid.geometry.size;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const Vec3 p = grid.geometry.lower_corner({x, y, z}) + Vec3::Constant(0.5 * kVoxel_m);
        if (!inside.holds(p)) continue;
        ghosts.voxels += grid.raw.get({x, y, z});
        if (!ahead.holds(p)) continue;
        ++voxels_ahead;
        ghosts.blocked_share += grid.grown.get({x, y, z});
      }
    }
  }
  ghosts.blocked_share /= std::max(voxels_ahead, 1);
  return ghosts;
}

void measure_false(Report& report, Preset preset, double share, int hits_needed) {
  SensorParameters parameters = preset_of(preset);
  parameters.returns.false_share = share;
  const SolidWorld world = room();
  LiveMap map = map_of(kRoomBox, options_of(hits_needed));
  Ghosts sum;
  int scans = 0;
  fly(parameters, world, hover(Vec3(-4.0, 0.0, 2.0)), 3.0, map, [&](double t) {
    if (t < kSettle_s) return;
    const Ghosts now = ghosts_in(map.grid());
    sum.voxels += now.voxels;
    sum.blocked_share += now.blocked_share;
    ++scans;
  });
  scans = std::max(scans, 1);
  report.add({{"table", "false returns"},
              {"preset", std::string(to_word(preset))},
              {"false_share", share},
              {"hits_needed", hits_needed},
              {"ghost_voxels", sum.voxels / scans},
              {"blocked_share", sum.blocked_share / scans}});
}

/// Flies along the room. @return of the floor's voxels that were ever obstacles, the share that is
/// free at the end
double eaten_share(Preset preset, bool keep_grazed, bool quick) {
  map_server::LiveOptions options = options_of(2);
  options.keep_grazed = keep_grazed;
  LiveMap map = map_of(kRoomBox, options);
  const double way_m = quick ? 4.0 : 14.0;
  const Flight flight = [=](double t) -> Pose {
    return {Vec3(-7.0 + 2.0 * t, 0.2 * std::sin(t), 1.5 + 0.1 * std::sin(2.0 * t)),
            Quaternion::Identity()};
  };
  const int layer = map.geometry().index_of(Vec3(0.0, 0.0, kFloor_m)).value().z;
  const Index3 n = map.geometry().size;
  std::vector<bool> ever(std::size_t(n.x) * std::size_t(n.y));
  std::vector<bool> now(ever.size());
  fly(preset_of(preset), room(), flight, way_m / 2.0, map, [&](double) {
    const VoxelGrid grid = map.grid();
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const auto at = std::size_t(y) * std::size_t(n.x) + std::size_t(x);
        now[at] = grid.raw.get({x, y, layer});
        ever[at] = ever[at] || now[at];
      }
    }
  });
  std::int64_t met = 0, eaten = 0;
  for (std::size_t k = 0; k < ever.size(); ++k) {
    met += ever[k];
    eaten += ever[k] && !now[k];
  }
  return double(eaten) / double(std::max<std::int64_t>(met, 1));
}

void run(Report& report) {
  const bool quick = report.options().quick;
  const std::vector<double> ranges_m =
      quick ? std::vector{3.1, 9.1} : std::vector{2.1, 3.1, 5.1, 7.1, 9.1, 12.1, 15.1, 20.1};
  const std::vector<double> shares =
      quick ? std::vector{0.01} : std::vector{0.001, 0.003, 0.01, 0.03, 0.1};
  for (const auto& named : words_of(Preset{})) {
    const bool dense = named.value == Preset::os0_128 || named.value == Preset::os1_128;
    if (quick && (dense || named.value == Preset::avia)) continue;
    report.progress(std::string(named.word));
    measure_thin(report, named.value, ranges_m);
    for (const double share : shares) {
      for (const int hits_needed : {1, 2, 3}) {
        measure_false(report, named.value, share, hits_needed);
      }
    }
    report.add({{"table", "floor"},
                {"preset", std::string(named.word)},
                {"eaten_share", eaten_share(named.value, true, quick)},
                {"eaten_share_without_grazing_rule", eaten_share(named.value, false, quick)}});
  }
  const Plot thin{.file = "pole",
                  .title = "A pole of 3 cm in the map",
                  .x = "range_m",
                  .y = "kept_share",
                  .x_label = "range [m]",
                  .y_label = "share of its voxels",
                  .series = "preset",
                  .where = {{"table", "thin"}, {"thing", "pole, 3 cm"}}};
  report.draw(thin);
  Plot other = thin;
  other.file = "wire";
  other.title = "A wire of 5 mm in the map";
  other.where["thing"] = "wire, 5 mm";
  report.draw(other);
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "senses", goshawk::bench::run);
}
