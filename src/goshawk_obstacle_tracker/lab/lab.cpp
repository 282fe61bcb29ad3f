#include "goshawk/obstacle_tracker_lab/lab.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include "goshawk/core/random.hpp"
#include "goshawk/sensors/joined_world.hpp"
#include "goshawk/sensors/moving_world.hpp"
#include "goshawk/sensors/solid_world.hpp"

namespace goshawk::obstacle_tracker {
namespace {

using sensors::Solid;

constexpr std::int64_t kStart_ns = 1'000'000'000;
constexpr std::int64_t kPose_ns = 10'000'000;

Result<std::shared_ptr<const sensors::World>> still_world(const LabCase& c) {
  std::vector<Solid> solids{Solid::box(Vec3(-20, -20, -0.2), Vec3(40, 20, 0)),
                            Solid::box(Vec3(-20, -20, 8), Vec3(40, 20, 8.2)),
                            Solid::box(Vec3(-20.2, -20, 0), Vec3(-20, 20, 8)),
                            Solid::box(Vec3(40, -20, 0), Vec3(40.2, 20, 8)),
                            Solid::box(Vec3(-20, -20.2, 0), Vec3(40, -20, 8)),
                            Solid::box(Vec3(-20, 20, 0), Vec3(40, 20.2, 8))};
  Random random(1);
  for (int i = 0; i < c.pillars; ++i) {
    // Beside the ways of movers and vehicle.
    const double x = random.uniform(-18.0, 38.0);
    const double y = (random.chance(0.5) ? 1.0 : -1.0) * random.uniform(7.0, 18.0);
    solids.push_back(Solid::cylinder(Vec3(x, y, 0.0), random.uniform(0.15, 0.5), 8.0));
  }
  auto world = sensors::SolidWorld::create(std::move(solids));
  if (!world) return world.error();
  std::shared_ptr<const sensors::World> shared =
      std::make_shared<const sensors::SolidWorld>(*std::move(world));
  return shared;
}

double processor_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * double(t.tv_sec) + 1e-3 * double(t.tv_nsec);
}

/// Places scans by the true poses, feeds the tracker, and keeps the score.
class Judged {
 public:
  Judged(const LabCase& c, ObstacleTracker tracker, const sensors::Pose& mount)
      : tracker_(std::move(tracker)), score_(c.movers), mount_(mount) {}

  Status take(const sensors::Scan& scan, const sensors::PoseTrack& poses) {
    points_.clear(), origins_.clear(), offsets_.clear();
    for (const sensors::Return& r : scan.returns) {
      if (!r.valid) continue;
      const auto pose = poses.at(scan.start_ns + r.offset_ns);
      if (!pose) continue;
      const Vec3 p_base = mount_.position_map + mount_.q_map_base * r.point.cast<double>();
      points_.push_back(pose->position_map + pose->q_map_base * p_base);
      origins_.push_back(pose->position_map + pose->q_map_base * mount_.position_map);
      offsets_.push_back(r.offset_ns);
    }
    const double before_us = processor_us();
    const auto status = tracker_.add({scan.start_ns, points_, origins_, offsets_});
    const double us = processor_us() - before_us;
    if (!status) return status;
    result_.scan_mean_us += us;
    result_.scan_most_us = std::max(result_.scan_most_us, us);
    ++result_.scans;
    score_.add(points_, tracker_.obstacles(), 1e-9 * double(tracker_.time_ns() - kStart_ns));
    return success();
  }

  LabResult result() const {
    LabResult result = result_;
    result.figures = score_.figures();
    result.scan_mean_us /= result.scans;
    return result;
  }

 private:
  ObstacleTracker tracker_;
  Score score_;
  sensors::Pose mount_;
  LabResult result_;
  std::vector<Vec3> points_, origins_;
  std::vector<std::int64_t> offsets_;
};

}  // namespace

sensors::SensorParameters lab_lidar() {
  sensors::SensorParameters p;
  sensors::apply_preset(sensors::Preset::os0_128, p);
  p.preset = sensors::Preset::os0_128;
  p.pattern.columns = 512;
  return p;
}

movers::Mover crossing_person(std::uint64_t id, double distance_m, double speed_m_s) {
  movers::WalkParameters p{.points_map = {Vec3(distance_m, -4.0, 0.9), Vec3(distance_m, 4.0, 0.9)},
                           .pauses_s = {3.0, 1.0},
                           .speed_m_s = speed_m_s};
  return {.id = id,
          .kind = "person",
          .half_m = Vec3(0.2, 0.25, 0.9),
          .motion = movers::Walk::create(p).value()};
}

Result<LabResult> run_lab(const LabCase& c) {
  auto tracker = ObstacleTracker::create(c.tracker);
  if (!tracker) return tracker.error();
  auto sensor = sensors::Sensor::create(c.sensor);
  if (!sensor) return sensor.error();
  const auto still = still_world(c);
  if (!still) return still.error();
  const sensors::JoinedWorld world(
      {*still, std::make_shared<sensors::MovingWorld>(c.movers, kStart_ns)});
  Judged judged(c, *std::move(tracker), sensor->mount());
  sensors::PoseTrack poses;
  Status failed = success();
  const auto steps = std::int64_t(1e9 * c.duration_s) / kPose_ns;
  for (std::int64_t i = 0; i <= steps && failed; ++i) {
    const double t_s = 1e-9 * double(i * kPose_ns);
    const Vec3 place = c.start_map + t_s * c.velocity_map;
    auto status = poses.add(kStart_ns + i * kPose_ns, {place, Quaternion::Identity()});
    if (!status) return status.error();
    status = sensor->advance(world, poses, [&](const sensors::Scan& scan) {
      if (failed) failed = judged.take(scan, poses);
    });
    if (!status) return status.error();
  }
  if (!failed) return failed.error();
  return judged.result();
}

}  // namespace goshawk::obstacle_tracker
