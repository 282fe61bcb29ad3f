#include "flight_lab.hpp"

#include <algorithm>
#include <stdexcept>

#include "growing_world.hpp"

namespace goshawk::goals {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr double kMessage_s = 0.001;  // over DDS

}  // namespace

FlightLab::FlightLab(std::shared_ptr<const VoxelGrid> map, std::uint64_t seed, const Delays& delays,
                     const navigator::Config& config, const Vec3& home_map,
                     const tracker::Config& tracker_config)
    : home_map_(home_map),
      map_(std::move(map)),
      random_(seed),
      delays_(delays),
      search_(path_search::PathSearch::create({}).value()),
      builder_(corridor_builder::CorridorBuilder::create({}).value()),
      optimizer_(trajectory_optimizer::TrajectoryOptimizer::create({}).value()),
      vehicle_(simulator::Quadrotor::create({}).value()),
      tracker_(tracker::Tracker::create(tracker_config).value()),
      navigator_(config, 1) {
  set_map(map_);
  if (!vehicle_.reset(home_map_, 0.0)) throw std::logic_error("the vehicle does not start");
  run(0.1);
}

void FlightLab::set_map(std::shared_ptr<const VoxelGrid> map) {
  map_ = std::move(map);
  search_.set_map(map_);
  tracker_.set_map(map_, now_ns());
  report_tracker();
  navigator_.on_map(map_, now_ns());
  take_orders();
}

Status FlightLab::goal(const Vec3& goal_map, double yaw_rad) {
  auto status = navigator_.on_goal(goal_map, yaw_rad, vehicle_.time_ns());
  take_orders();
  return status;
}

bool FlightLab::run(double at_most_s, const std::function<bool()>& done) {
  const std::int64_t end_ns = vehicle_.time_ns() + std::int64_t(at_most_s * 1e9);
  while (vehicle_.time_ns() < end_ns) {
    step();
    if (watch) watch();
    if (done()) return true;
  }
  return false;
}

Vec3 FlightLab::random_place() {
  const Index3 size = map_->geometry.size;
  while (true) {
    const Index3 i{random_.below(size.x), random_.below(size.y), random_.below(size.z)};
    if (map_->grown.test(i)) continue;
    const Vec3 place = map_->geometry.center(i);
    if (search_.plan(home_map_, place)) return place;
  }
}

void FlightLab::step() {
  const std::int64_t now = vehicle_.time_ns();
  while (!events_.empty() && events_.front().time_ns <= now) {
    const auto act = std::move(events_.front().act);
    events_.pop_front();
    act();
  }
  if (now % (4 * kMillisecond) == 0) {
    const auto measured = vehicle_.measure();
    navigator_.on_odometry(measured.state, now);
    if (const auto command = tracker_.step(measured.state, measured.time_ns, now)) {
      if (auto status = vehicle_.command(*command); !status) {
        throw std::logic_error(status.error().message);
      }
    }
    report_tracker();
    const auto tracking = tracker_.status();
    navigator_.on_tracking(tracking.trajectory_id, tracking.mode == tracker::Mode::follow, now);
    take_orders();
    max_error_m_ = std::max(max_error_m_, tracker_.status().error_m);
  }
  if (now % (20 * kMillisecond) == 0) {
    tracker_.heard_navigator(now);
    navigator_.tick(now);
    take_orders();
  }
  if (auto status = vehicle_.advance(0.001); !status)
    throw std::logic_error(status.error().message);
  max_speed_m_s_ = std::max(max_speed_m_s_, speed());
  if (obstacle_distance_m(truth_ ? *truth_ : *map_, position(), kBody_m) < kBody_m) ++contacts_;
}

void FlightLab::in(double seconds, std::function<void()> act) {
  const Event event{vehicle_.time_ns() + std::int64_t(seconds * 1e9), std::move(act)};
  const auto at = std::ranges::upper_bound(events_, event.time_ns, {}, &Event::time_ns);
  events_.insert(at, event);
}

void FlightLab::take_orders() {
  for (auto& order : navigator_.take_orders()) {
    std::visit([this](const auto& o) { obey(o); }, order);
  }
}

void FlightLab::obey(const PlanRequest& request) {
  ++plans_;
  if (!planning_lives_) return;
  auto planned = plan(request);
  const bool late = random_.chance(delays_.late_share);
  const double delay_s = random_.uniform(delays_.plan_min_s, delays_.plan_max_s) +
                         (late ? random_.uniform(0.0, delays_.late_s) : 0.0);
  in(delay_s, [this, id = request.id, planned = std::move(planned)] {
    const std::int64_t now = vehicle_.time_ns();
    if (planned.answer) {
      navigator_.on_trajectory(*planned.answer, ++answers_, now);
    } else {
      navigator_.on_report(id, planned.last, planned.answer.error(), now);
    }
    take_orders();
  });
}

FlightLab::Planned FlightLab::plan(const PlanRequest& request) {
  const auto path = search_.plan(request);
  if (!path) return {path.error(), StageRole::path_search};
  const auto corridor = builder_.build(*map_, path->waypoints_map);
  if (!corridor) return {corridor.error(), StageRole::corridor_builder};
  auto solution = optimizer_.optimise(request, *corridor);
  if (!solution) return {solution.error(), StageRole::trajectory_optimizer};
  return {Commitment{.id = request.id,
                     .nominal = std::move(solution->certified),
                     .map_version = map_->version,
                     .yaw_curve = std::move(solution->yaw)},
          StageRole::trajectory_optimizer};
}

void FlightLab::obey(const navigator::Commit& commit) {
  ++commits_;
  in(kMessage_s, [this, committed = commit.trajectory] {
    const std::int64_t now = vehicle_.time_ns();
    const auto status = tracker_.accept(committed, now);
    if (!status) refusals.push_back(status.error());
    if (status) flown_ = committed;
    const Error outcome = status ? Error{ErrorCode::ok, ""} : status.error();
    in(kMessage_s, [this, id = committed.id(), outcome] {
      navigator_.on_report(id, StageRole::tracker, outcome, vehicle_.time_ns());
      take_orders();
    });
  });
}

void FlightLab::report_tracker() {
  const auto status = tracker_.status();
  if (status.lost_trajectory_id != 0 && status.fault.message != reported_) {
    reported_ = status.fault.message;
    losses.push_back(status.fault);
    in(kMessage_s, [this, id = status.lost_trajectory_id, fault = status.fault] {
      navigator_.on_report(id, StageRole::tracker, fault, vehicle_.time_ns());
      take_orders();
    });
  }
}

}  // namespace goshawk::goals
