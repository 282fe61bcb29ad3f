#include "goshawk/closed_loop/flight_lab.hpp"

#include <algorithm>
#include <stdexcept>

#include "goshawk/closed_loop/obstacle_distance.hpp"

namespace goshawk::closed_loop {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr double kMessage_s = 0.001;  // over DDS

}  // namespace

FlightLab::FlightLab(std::shared_ptr<const VoxelGrid> map, std::uint64_t seed, const Setup& setup)
    : setup_(setup),
      map_(std::move(map)),
      random_(seed),
      planning_(Planning::create(setup.planning).value()),
      vehicle_(make_vehicle(setup.tracking, setup.vehicle, setup.home_map).value()),
      tracker_(tracker::Tracker::create(setup.tracker).value()),
      navigator_(setup.navigator, 1) {
  set_map(map_);
  run(0.1);
}

void FlightLab::set_map(std::shared_ptr<const VoxelGrid> map) {
  map_ = std::move(map);
  planning_.set_map(map_);
  tracker_.set_map(map_, now_ns());
  report_tracker();
  navigator_.on_map(map_, now_ns());
  take_orders();
}

Status FlightLab::goal(const Vec3& goal_map, double yaw_rad) {
  auto status = navigator_.on_goal(goal_map, yaw_rad, now_ns());
  take_orders();
  return status;
}

bool FlightLab::run(double at_most_s, const std::function<bool()>& done) {
  const std::int64_t end_ns = now_ns() + std::int64_t(at_most_s * 1e9);
  while (now_ns() < end_ns) {
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
    if (planning_.search().plan(setup_.home_map, place)) return place;
  }
}

void FlightLab::step() {
  const std::int64_t now = now_ns();
  while (!events_.empty() && events_.front().time_ns <= now) {
    const auto act = std::move(events_.front().act);
    events_.pop_front();
    act();
  }
  if (now % (4 * kMillisecond) == 0) exchange(now);
  if (now % (20 * kMillisecond) == 0) {
    tracker_.heard_navigator(now);
    navigator_.tick(now);
    take_orders();
  }
  vehicle_->advance();
  max_speed_m_s_ = std::max(max_speed_m_s_, speed());
  if (obstacle_distance_m(truth_ ? *truth_ : *map_, position(), kBody_m) < kBody_m) ++contacts_;
}

// Odometry out, a command in.
void FlightLab::exchange(std::int64_t now) {
  const auto measured = vehicle_->measure();
  navigator_.on_odometry(measured.state, now);
  if (const auto command = tracker_.step(measured.state, measured.time_ns, now)) {
    if (auto status = vehicle_->command(*command, tracker_.status().reference); !status) {
      throw std::logic_error(status.error().message);
    }
  }
  report_tracker();
  const auto tracking = tracker_.status();
  navigator_.on_tracking(tracking.trajectory_id, tracking.mode == tracker::Mode::follow, now);
  take_orders();
  max_error_m_ = std::max(max_error_m_, tracking.error_m);
}

void FlightLab::in(double seconds, std::function<void()> act) {
  const Event event{now_ns() + std::int64_t(seconds * 1e9), std::move(act)};
  const auto at = std::ranges::upper_bound(events_, event.time_ns, {}, &Event::time_ns);
  events_.insert(at, event);
}

void FlightLab::take_orders() {
  for (auto& order : navigator_.take_orders()) {
    std::visit([this](const auto& o) { obey(o); }, order);
  }
}

double FlightLab::timed_s(const std::function<void()>& work) {
  if (setup_.delays.stopwatch) return setup_.delays.stopwatch(work);
  work();
  return 0.0;
}

void FlightLab::obey(const PlanRequest& request) {
  ++plans_;
  if (!planning_lives_) return;
  auto planned =
      planning_.plan(request, [this](const std::function<void()>& work) { return timed_s(work); });
  const double delay = delay_s(planned.times.all_s());
  in(delay, [this, request, planned = std::move(planned)] { answer(request, planned); });
}

double FlightLab::delay_s(double computed_s) {
  const Delays& d = setup_.delays;
  busy_until_ns_ = std::max(busy_until_ns_, now_ns()) + std::int64_t(computed_s * 1e9);
  const bool late = random_.chance(d.late_share);
  return double(busy_until_ns_ - now_ns()) * 1e-9 + random_.uniform(d.plan_min_s, d.plan_max_s) +
         (late ? random_.uniform(0.0, d.late_s) : 0.0);
}

void FlightLab::answer(const PlanRequest& request, Planning::Answer planned) {
  const double checked_s = timed_s([&] {
    for (const StageRole stage : {StageRole::path_search, StageRole::corridor_builder}) {
      if (stage == planned.last) break;
      navigator_.on_report(request.id, stage, Error{ErrorCode::ok, ""}, now_ns(),
                           planned.shortfall);
    }
    if (planned.commitment) {
      navigator_.on_trajectory(*std::move(planned.commitment), ++answers_, now_ns());
    } else {
      failures.push_back(planned.commitment.error());
      navigator_.on_report(request.id, planned.last, planned.commitment.error(), now_ns());
    }
  });
  if (setup_.delays.stopwatch) replans_.push_back({planned.times, checked_s});
  take_orders();
}

void FlightLab::obey(const navigator::Commit& commit) {
  ++commits_;
  in(kMessage_s, [this, committed = commit.trajectory] {
    const auto status = tracker_.accept(committed, now_ns());
    if (!status) refusals.push_back(status.error());
    if (status) flown_ = committed;
    if (status && on_commit) on_commit(committed);
    const Error outcome = status ? Error{ErrorCode::ok, ""} : status.error();
    in(kMessage_s, [this, id = committed.id(), outcome] {
      navigator_.on_report(id, StageRole::tracker, outcome, now_ns());
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
      navigator_.on_report(id, StageRole::tracker, fault, now_ns());
      take_orders();
    });
  }
}

}  // namespace goshawk::closed_loop
