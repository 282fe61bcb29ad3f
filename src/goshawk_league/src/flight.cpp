#include "goshawk/league/flight.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "goshawk/closed_loop/obstacle_distance.hpp"
#include "record.hpp"

namespace goshawk::league {
namespace {

using closed_loop::FlightLab;
using closed_loop::LiveMapper;
using closed_loop::Stopwatch;

constexpr double kResolution_m = 0.2;
constexpr double kInflation_m = closed_loop::kBody_m + closed_loop::kTrackingMargin_m;
// A voxel that a trunk only grazes is known to be an obstacle late, when it is near.
constexpr double kReserve_m = kResolution_m;
constexpr double kHorizon_m = 40.0;  // of a plan: beyond the lidar's range
constexpr double kLook_s = 0.5;      // before the goal is given: the first scans
constexpr double kMessage_s = 0.002;
constexpr double kThere_m = 0.1;     // the vehicle has arrived: so near, and
constexpr double kAtRest_m_s = 0.1;  // so slow
constexpr std::int64_t kSample_ns = 4'000'000;

Stopwatch stopwatch_of(const Options& options) {
  if (!options.latency_s) return closed_loop::processor_time_s;
  return [s = *options.latency_s](const std::function<void()>& work) {
    work();
    return s;
  };
}

closed_loop::Setup setup_of(const Scene& scene, const Options& options) {
  closed_loop::Setup setup = options.vehicle;
  setup.tracking = options.tracking;
  setup.home_map = scene.start;
  setup.delays = {.plan_min_s = kMessage_s,
                  .plan_max_s = kMessage_s,
                  .late_share = 0.0,
                  .stopwatch = stopwatch_of(options)};
  // The vehicle's own limits hold beside the scene's; an ideal one takes any jerk.
  auto& n = setup.navigator;
  n.v_max_m_s = std::min(n.v_max_m_s, scene.limits.v_max_m_s);
  n.a_max_m_s2 = std::min(n.a_max_m_s2, scene.limits.a_max_m_s2);
  const bool takes_any = options.tracking == closed_loop::Tracking::ideal || n.j_max_m_s3 <= 0.0;
  n.j_max_m_s3 =
      takes_any ? scene.limits.j_max_m_s3 : std::min(n.j_max_m_s3, scene.limits.j_max_m_s3);
  n.j_max_in_flight_m_s3 = n.j_max_m_s3;
  n.limit_norm = scene.limits.norm;
  n.unknown = UnknownSpace::free;
  if (!options.known) setup.planning.corridor.horizon_m = kHorizon_m;
  return setup;
}

Result<LiveMapper> mapper_of(const Scene& scene, const Options& options) {
  auto world = to_sensor_world(scene.solids);
  if (!world) return world.error();
  return LiveMapper::create({.sensor = league_lidar(options),
                             .box = scene.box,
                             .resolution_m = kResolution_m,
                             .inflation_m = kInflation_m,
                             .reserve_m = kReserve_m,
                             .body_radius_m = 2.0 * kInflation_m},
                            *world);
}

/// A flight in the making.
class Flight {
 public:
  Flight(const Scene& scene, const closed_loop::Setup& setup, std::uint64_t seed,
         std::shared_ptr<const VoxelGrid> map)
      : scene_(scene), stopwatch_(setup.delays.stopwatch), lab_(std::move(map), seed, setup) {}

  /// Each scan is in the map as late as it takes to insert it.
  void see_by(LiveMapper& mapper) { mapper_ = &mapper; }

  Outcome fly() {
    lab_.watch = [this] { watch(); };
    if (mapper_ != nullptr) lab_.run(kLook_s);
    begin_ns_ = lab_.now_ns();
    if (auto status = lab_.goal(scene_.goal); !status) {
      outcome_.code = status.code();
      outcome_.reason = status.error().message;
      return std::move(outcome_);
    }
    lab_.run(scene_.longest_s, [this] { return is_over(); });
    outcome_.arrived = is_there();
    if (!outcome_.arrived) {
      const Error why = why_not();
      outcome_.code = why.code;
      outcome_.reason = why.message;
    }
    outcome_.time_s = lab_.now_s() - double(*begin_ns_) * 1e-9;
    outcome_.max_error_m = lab_.max_error_m();
    outcome_.plans = lab_.plans();
    outcome_.failed_plans = int(lab_.failures.size());
    outcome_.commits = lab_.commits();
    outcome_.replans = lab_.replans();
    return std::move(outcome_);
  }

 private:
  void watch() {
    if (mapper_ != nullptr && lab_.now_ns() % kSample_ns == 0) look();
    if (!begin_ns_ || (lab_.now_ns() - *begin_ns_) % kSample_ns != 0) return;
    record({.t_s = double(lab_.now_ns() - *begin_ns_) * 1e-9,
            .vehicle = lab_.vehicle(),
            .reference = lab_.tracker().status().reference},
           scene_.limits, outcome_);
    note_events();
    const bool moves = lab_.moves();
    if (moved_ && !moves && !is_there()) ++outcome_.stops;
    moved_ = moves;
  }

  void note_events() {
    const auto note = [&](std::size_t& noted, const std::vector<Error>& all, const char* what) {
      for (; noted < all.size(); ++noted)
        note_event(fmt::format("{}: {}", what, all[noted].message));
    };
    note(losses_, lab_.losses, "lost");
    note(refusals_, lab_.refusals, "refused");
    note(failures_, lab_.failures, "plan failed");
    if (lab_.state().reason.message == reason_) return;
    reason_ = lab_.state().reason.message;
    if (!reason_.empty()) note_event("navigator: " + reason_);
  }
  void note_event(const std::string& what) {
    const double t_s = double(lab_.now_ns() - *begin_ns_) * 1e-9;
    outcome_.events.push_back(
        fmt::format("{:.2f} s at {}: {}", t_s, to_text(lab_.position()), what));
  }

  void look() {
    bool changed = false;
    std::optional<Error> blind;
    const double took_s = stopwatch_([&] {
      const auto seen = mapper_->look(lab_.now_ns(), {lab_.position(), lab_.vehicle().q_map_base});
      changed = seen && *seen;
      if (!seen) blind = seen.error();
    });
    if (blind && !blind_) blind_ = blind;
    if (!changed) return;
    outcome_.scan_s.push_back(took_s);
    lab_.in(took_s + kMessage_s, [this, map = mapper_->map()] { lab_.set_map(map); });
  }

  /// The reference is at rest at the goal, and the vehicle hardly moves beside it.
  bool is_there() {
    const FlatState reference = lab_.tracker().status().reference;
    return (reference.position - scene_.goal).norm() < 1e-3 && reference.velocity.norm() < 1e-3 &&
           (lab_.position() - scene_.goal).norm() < kThere_m && lab_.speed() < kAtRest_m_s;
  }
  bool is_over() { return is_there() || lab_.state().state == navigator::State::failed; }
  Error why_not() const {
    if (blind_) return *blind_;
    if (lab_.state().state == navigator::State::failed) return lab_.state().reason;
    return fail(ErrorCode::deadline_exceeded,
                fmt::format("not there after {:g} s", scene_.longest_s));
  }

  const Scene& scene_;
  Stopwatch stopwatch_;
  FlightLab lab_;
  LiveMapper* mapper_ = nullptr;
  std::optional<std::int64_t> begin_ns_;
  bool moved_ = false;
  std::size_t losses_ = 0, refusals_ = 0, failures_ = 0;  // noted
  std::string reason_;
  std::optional<Error> blind_;  // why there was no scan
  Outcome outcome_;
};

}  // namespace

double plan_clearance_m() {
  return kInflation_m + kReserve_m;
}

sensors::SensorParameters league_lidar(const Options& options) {
  sensors::SensorParameters lidar;
  lidar.pattern.rate_hz = 10.0;
  lidar.pattern.channels = 64;
  lidar.pattern.columns = 512;
  lidar.pattern.elevation_lower_rad = -45.0 * sensors::kDegree;
  lidar.pattern.elevation_upper_rad = 45.0 * sensors::kDegree;
  lidar.returns.range_min_m = 0.1;
  lidar.pattern.azimuth_width_rad = options.view_rad;
  lidar.returns.range_max_m = options.range_m;
  lidar.returns.range_noise_m = options.range_noise_m;
  lidar.mount.z_m = 0.0;
  lidar.seed = int(options.seed % 1'000'000);
  return lidar;
}

Result<Outcome> fly(const Scene& scene, const Options& options) {
  const auto setup = setup_of(scene, options);
  Outcome outcome;
  if (options.known) {
    auto map = known_map(scene, kResolution_m, kInflation_m);
    if (!map) return map.error();
    outcome = Flight(scene, setup, options.seed + 1, *std::move(map)).fly();
  } else {
    auto mapper = mapper_of(scene, options);
    if (!mapper) return mapper.error();
    Flight flight(scene, setup, options.seed + 1, mapper->map());
    flight.see_by(*mapper);
    outcome = flight.fly();
  }
  if (auto status = judge(scene, outcome); !status) return status.error();
  return outcome;
}

}  // namespace goshawk::league
