#include "goshawk/closed_loop/live_mapper.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "goshawk/core/grid_update.hpp"

namespace goshawk::closed_loop {

using map_server::LiveMap;
using map_server::UnknownPolicy;

Result<LiveMapper> LiveMapper::create(const Config& config,
                                      std::shared_ptr<const sensors::World> world) {
  if (config.missing_is_free && config.sensor.returns.range_min_m > config.inflation_m) {
    return fail(
        ErrorCode::invalid_parameter,
        fmt::format("range_min_m of {:g} m is above the inflation of {:g} m: a surface that "
                    "is too near gives no return either, so that missing returns cannot "
                    "count as free",
                    config.sensor.returns.range_min_m, config.inflation_m));
  }
  auto sensor = sensors::Sensor::create(config.sensor);
  if (!sensor) return sensor.error();
  auto live = LiveMap::unknown_space(config.box, config.resolution_m,
                                     {.unknown = UnknownPolicy::free,
                                      .inflation_m = config.inflation_m,
                                      .reserve_m = config.reserve_m});
  if (!live) return live.error();
  return LiveMapper(config, std::move(world), *std::move(sensor), *std::move(live));
}

LiveMapper::LiveMapper(const Config& config, std::shared_ptr<const sensors::World> world,
                       sensors::Sensor sensor, LiveMap live)
    : config_(config),
      world_(std::move(world)),
      sensor_(std::move(sensor)),
      live_(std::move(live)),
      grid_(live_.grid()) {
  publish();
}

// Copies share their chunks until one of them changes.
void LiveMapper::publish() {
  map_ = std::make_shared<const VoxelGrid>(grid_);
}

Result<bool> LiveMapper::look(std::int64_t time_ns, const sensors::Pose& pose) {
  if (auto status = track_.add(time_ns, pose); !status) return status.error();
  if (path_map_.empty() || (path_map_.back() - pose.position_map).norm() > config_.resolution_m) {
    path_map_.push_back(pose.position_map);
  }
  changed_ = false;
  auto status = sensor_.advance(*world_, track_, [this](const sensors::Scan& s) { insert(s); });
  if (!status) return status.error();
  return changed_;
}

void LiveMapper::insert(const sensors::Scan& scan) {
  points_map_.clear();
  origins_map_.clear();
  const double beyond_m = config_.sensor.returns.range_max_m + 2.0 * config_.resolution_m;
  for (std::size_t i = 0; i < scan.returns.size(); ++i) {
    const sensors::Return& r = scan.returns[i];
    if (!r.valid && !config_.missing_is_free) continue;
    const auto body = track_.at(scan.start_ns + r.offset_ns);
    if (!body) continue;
    const sensors::Pose& mount = sensor_.mount();
    const Vec3 origin = body->position_map + body->q_map_base * mount.position_map;
    const Vec3 in_sensor =
        r.valid ? Vec3(r.point.cast<double>())
                : Vec3(beyond_m * sensor_.pattern().at(scan.number, int(i)).direction_sensor);
    points_map_.push_back(origin + body->q_map_base * (mount.q_map_base * in_sensor));
    origins_map_.push_back(origin);
  }
  path_map_.push_back(track_.at(track_.last_ns())->position_map);
  const auto status = live_.insert_scan({.points_map = points_map_,
                                         .origins_map = origins_map_,
                                         .max_range_m = config_.sensor.returns.range_max_m,
                                         .body_path_map = path_map_,
                                         .body_radius_m = config_.body_radius_m},
                                        result_);
  if (!status) throw std::logic_error(status.error().message);
  path_map_.clear();
  ++scans_;
  if (auto applied = apply(grid_, result_.update); !applied) {
    throw std::logic_error(applied.error().message);
  }
  publish();
  changed_ = true;
}

}  // namespace goshawk::closed_loop
