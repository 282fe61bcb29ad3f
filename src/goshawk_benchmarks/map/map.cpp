// goshawk bench map: scans into the live map, with growth, beside OctoMap's insertPointCloud of the
// same points in the same run. The vehicle flies through a made hall; each scan comes from another
// place. Processor time of the thread.

#include <octomap/OcTree.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/measure.hpp"
#include "common/report.hpp"
#include "goshawk/conversions/grid.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "map/processes.hpp"

namespace goshawk::bench {
namespace {

using map_server::LiveMap;

constexpr double kInflation_m = 0.2;
constexpr double kNoise_m = 0.02;

struct Pillar {
  double x, y, radius;
};

/// A hall of 70 x 70 x 8 m with pillars.
class Hall {
 public:
  explicit Hall(Random& random) {
    while (pillars_.size() < 60) {
      const Pillar p{random.uniform(-33, 33), random.uniform(-33, 33), random.uniform(0.2, 1.0)};
      if (std::abs(p.y) > p.radius + 1.0) pillars_.push_back(p);  // the way stays free
    }
  }

  /// @return [m] along the ray to what it meets first
  double range(const Vec3& from, const Vec3& way) const {
    double range = std::numeric_limits<double>::infinity();
    const Vec3 lower(-35, -35, 0), upper(35, 35, 8);
    for (int a = 0; a < 3; ++a) {
      if (way[a] != 0.0) {
        range = std::min(range, ((way[a] > 0.0 ? upper[a] : lower[a]) - from[a]) / way[a]);
      }
    }
    const double a = way.x() * way.x() + way.y() * way.y();
    for (const Pillar& p : pillars_) {
      const double dx = from.x() - p.x, dy = from.y() - p.y;
      const double b = dx * way.x() + dy * way.y();
      const double root = b * b - a * (dx * dx + dy * dy - p.radius * p.radius);
      if (root >= 0.0 && b < 0.0) range = std::min(range, (-b - std::sqrt(root)) / a);
    }
    return range;
  }

 private:
  std::vector<Pillar> pillars_;
};

struct Sensor {
  std::string name;
  int columns, rows;
  double across_rad, up_rad, down_rad;  // field of view
};

std::vector<Vec3> scan_of(const Hall& hall, const Sensor& s, const Vec3& from, Random& random) {
  std::vector<Vec3> points;
  for (int row = 0; row < s.rows; ++row) {
    const double up = s.down_rad + (s.up_rad - s.down_rad) * row / (s.rows - 1);
    for (int k = 0; k < s.columns; ++k) {
      const double angle = s.across_rad * (double(k) / s.columns - 0.5);
      const Vec3 way(std::cos(angle) * std::cos(up), std::sin(angle) * std::cos(up), std::sin(up));
      points.push_back(from + (hall.range(from, way) + random.uniform(-kNoise_m, kNoise_m)) * way);
    }
  }
  return points;
}

std::vector<Shot> fly(const Hall& hall, const Sensor& sensor, int count) {
  Random random(11);
  std::vector<Shot> shots;
  for (int k = 0; k < count; ++k) {
    const Vec3 from(-10.0 + 0.2 * k, 0.3 * std::sin(0.1 * k), 1.5);  // 2 m/s, 10 Hz
    shots.push_back({from, scan_of(hall, sensor, from, random)});
  }
  return shots;
}

/// A cloud of a file, as if the sensor hovered and trembled.
Result<std::vector<Shot>> hover(const std::string& path, int count) {
  const auto points = map_server::load_points(path);
  if (!points) return points.error();
  Random random(12);
  std::vector<Shot> shots;
  for (int k = 0; k < count; ++k) {
    Shot shot{Vec3(0.02 * std::sin(0.5 * k), 0.02 * std::cos(0.5 * k), 0.0), {}};
    for (const Vec3& p : *points) {
      if (!p.allFinite() || p.norm() < 0.1) continue;
      shot.points.push_back(p + random.uniform(-kNoise_m, kNoise_m) * p.normalized());
    }
    shots.push_back(std::move(shot));
  }
  return shots;
}

std::int64_t changed_voxels(const VoxelGrid& a, const VoxelGrid& b) {
  std::int64_t changed = 0;
  for_changed_chunks(a.known, b.known, [&](const BitGrid::Rows& rows) {
    for (int z = rows.z0; z < rows.z1; ++z) {
      for (int y = rows.y0; y < rows.y1; ++y) {
        for (std::size_t w = 0; w < a.known.words_per_row(); ++w) {
          changed += std::popcount(a.known.row(y, z)[w] ^ b.known.row(y, z)[w]);
        }
      }
    }
  });
  for_changed_chunks(a.raw, b.raw, [&](const BitGrid::Rows& rows) {
    for (int z = rows.z0; z < rows.z1; ++z) {
      for (int y = rows.y0; y < rows.y1; ++y) {
        for (std::size_t w = 0; w < a.raw.words_per_row(); ++w) {
          changed +=
              std::popcount((a.raw.row(y, z)[w] ^ b.raw.row(y, z)[w]) & a.known.row(y, z)[w]);
        }
      }
    }
  });
  return changed;
}

struct Case {
  std::string sensor;
  double resolution_m, range_m;
};

Result<nlohmann::ordered_json> measure(const Case& c, const std::vector<Shot>& shots,
                                       int octomap_shots) {
  const double half_m = 32.0;
  auto map =
      LiveMap::unknown_space({Vec3(-half_m, -half_m, -4), Vec3(half_m, half_m, 10)}, c.resolution_m,
                             {map_server::UnknownPolicy::blocked, kInflation_m});
  if (!map) return map.error();
  map_server::ScanResult result;
  goshawk_msgs::msg::VoxelGridUpdate message;
  std::vector<double> scan_us, publish_us;
  std::int64_t changed = 0;
  for (const Shot& shot : shots) {
    const VoxelGrid before = map->grid();
    const map_server::Scan scan{
        .points_map = shot.points, .origins_map = {&shot.from, 1}, .max_range_m = c.range_m};
    Status status = success();
    scan_us.push_back(time_us([&] { status = map->insert_scan(scan, result); }, Clock::processor));
    if (!status) return status.error();
    publish_us.push_back(
        time_us([&] { conversions::fill_msg(result.update, message); }, Clock::processor));
    changed += changed_voxels(before, map->grid());
  }
  octomap::OcTree tree(c.resolution_m);
  std::vector<double> octomap_us;
  for (int k = 0; k < octomap_shots; ++k) {
    const Shot& shot = shots[std::size_t(k)];
    octomap::Pointcloud cloud;
    for (const Vec3& p : shot.points) cloud.push_back(float(p.x()), float(p.y()), float(p.z()));
    const octomap::point3d from(float(shot.from.x()), float(shot.from.y()), float(shot.from.z()));
    octomap_us.push_back(
        time_us([&] { tree.insertPointCloud(cloud, from, c.range_m); }, Clock::processor));
  }
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double v : values) sum += v;
    return sum / double(values.size());
  };
  const double ours = mean(scan_us), theirs = mean(octomap_us);
  std::ranges::sort(scan_us);
  std::ranges::sort(publish_us);
  return nlohmann::ordered_json{{"sensor", c.sensor},
                                {"points", shots.front().points.size()},
                                {"resolution_m", c.resolution_m},
                                {"range_m", c.range_m},
                                {"mean_us", ours},
                                {"p99_us", at_share(scan_us, 0.99)},
                                {"octomap_mean_us", theirs},
                                {"times_faster", theirs / ours},
                                {"publish_p99_us", at_share(publish_us, 0.99)},
                                {"memory_mb", 1e-6 * double(map->memory_bytes())},
                                {"voxels_changed", changed / std::int64_t(shots.size())}};
}

/// From the cloud's message to a planner's map over separate processes, in a window of 12.5 million
/// voxels. A row of its own table.
Result<nlohmann::ordered_json> measure_latency(const std::vector<Shot>& shots) {
  const ProcessesOptions options{.lower_map = Vec3(-25, -25, -18), .upper_map = Vec3(25, 25, 22)};
  auto samples = measure_processes(shots, options);
  if (!samples) return samples.error();
  std::ranges::sort(samples->total_ms);
  return nlohmann::ordered_json{{"table", "processes"},
                                {"sensor", "lidar"},
                                {"points", shots.front().points.size()},
                                {"resolution_m", options.resolution_m},
                                {"range_m", options.range_m},
                                {"scans", samples->total_ms.size()},
                                {"lost", samples->lost},
                                {"median_ms", at_share(samples->total_ms, 0.5)},
                                {"p90_ms", at_share(samples->total_ms, 0.9)},
                                {"p99_ms", at_share(samples->total_ms, 0.99)}};
}

int run(const Call& call) {
  Report report("map", Options::of(call));
  const bool quick = report.options().quick;
  const int scans = quick ? 10 : 100, octomap_scans = quick ? 2 : 10;
  Random random(7);
  const Hall hall(random);
  const double pi = std::numbers::pi;
  const Sensor lidar{"lidar", 1024, 48, 2.0 * pi, 0.35, -0.45};
  const Sensor sparse{"lidar", 512, 24, 2.0 * pi, 0.35, -0.45};
  const Sensor depth{"depth", 200, 150, 1.5, 0.5, -0.5};
  const auto add = [&](const Case& c, const std::vector<Shot>& shots) -> Status {
    auto row = measure(c, shots, octomap_scans);
    if (!row) return row.error();
    report.add(*std::move(row));
    return success();
  };
  const auto all = [&]() -> Status {
    const std::string file = call.value("cloud", "");
    if (!file.empty()) {
      const auto shots = hover(file, scans);
      if (!shots) return shots.error();
      return add({"file", 0.2, 30.0}, *shots);
    }
    const auto lidar_shots = fly(hall, lidar, scans);
    if (call.value("processes", false)) {
      auto row = measure_latency(lidar_shots);
      if (!row) return row.error();
      report.add(*std::move(row));
      return success();
    }
    for (const Case& c : {Case{"lidar", 0.2, 30.0},
                          {"lidar", 0.2, 10.0},
                          {"lidar", 0.4, 30.0},
                          {"lidar", 0.1, 30.0}}) {
      if (quick && c.resolution_m < 0.2) continue;
      if (auto s = add(c, lidar_shots); !s) return s;
    }
    if (auto s = add({"lidar", 0.2, 30.0}, fly(hall, sparse, scans)); !s) return s;
    return add({"depth", 0.2, 5.0}, fly(hall, depth, scans));
  }();
  if (!all) return report_failure("map", report.options().json, all.error());
  return report.finish();
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_call(argc, argv, "map", goshawk::bench::run);
}
