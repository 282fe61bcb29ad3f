#include "guard_lab.hpp"

#include <octomap/octomap.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "goshawk/core/inflation.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::guarded {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr double kMessage_s = 0.001;
constexpr double kInflation_m = 0.2;  // the body's radius and the margin for tracking

guard::Tracking tracking_of(const tracker::TrackingStatus& status) {
  using Mode = guard::Tracking::Mode;
  switch (status.mode) {
    case tracker::Mode::hold:
      return {Mode::holds, status.reference.position};
    case tracker::Mode::follow:
      return {Mode::follows, status.reference.position};
    case tracker::Mode::brake:
      return {Mode::brakes, status.reference.position};
    default:
      return {};
  }
}

std::unique_ptr<octomap::OcTree> tree_of(const worlds::World& world) {
  auto tree = std::make_unique<octomap::OcTree>(world.geometry.resolution_m);
  const Index3 size = world.geometry.size;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (!world.occupied.get({x, y, z})) continue;
        const Vec3 p = world.geometry.center({x, y, z});
        tree->updateNode(p.x(), p.y(), p.z(), true, true);
      }
    }
  }
  return tree;
}

}  // namespace

SeenWorld::SeenWorld(const worlds::World& world, double range_m)
    : world_(world),
      range_m_(range_m),
      known_(world.geometry.size, false),
      raw_(world.geometry.size, true, false) {}

bool SeenWorld::see_from(const Vec3& p_map) {
  bool changed = false;
  const Index3 size = world_.geometry.size;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const Index3 i{x, y, z};
        if (known_.get(i) || (world_.geometry.center(i) - p_map).norm() > range_m_) continue;
        known_.set(i, true);
        raw_.set(i, world_.occupied.get(i));
        changed = true;
      }
    }
  }
  if (!changed) return false;
  map_ = std::make_shared<const VoxelGrid>(
      VoxelGrid{.geometry = world_.geometry,
                .grown = inflate(raw_, kInflation_m, world_.geometry.resolution_m).value(),
                .known = known_,
                .raw = raw_,
                .version = ++version_,
                .inflation_m = kInflation_m,
                .unknown_is_occupied = false});
  return true;
}

GuardLab::GuardLab(const worlds::World& world, double range_m, const Vec3& home_map,
                   const guard::Config& config)
    : world_(world, range_m),
      vehicle_(simulator::Quadrotor::create({}).value()),
      tracker_(tracker::Tracker::create({}).value()),
      guard_(config, guard::make_repair(), 1) {
  if (!vehicle_.reset(home_map, 0.0)) throw std::logic_error("the vehicle does not start");
  run(0.2);
}

void GuardLab::run(double seconds, const std::function<void()>& tick) {
  const std::int64_t end_ns = now_ns() + std::int64_t(seconds * 1e9);
  while (now_ns() < end_ns) {
    if (now_ns() % (20 * kMillisecond) == 0) tick();
    step();
  }
}

void GuardLab::send(guard::Plan plan, double delay_s) {
  in(delay_s, [this, plan = std::move(plan)] {
    decisions.push_back(guard_.on_plan(plan, now_ns()));
    take_commits();
  });
}

void GuardLab::in(double seconds, std::function<void()> act) {
  const Event event{now_ns() + std::int64_t(seconds * 1e9), std::move(act)};
  events_.insert(std::ranges::upper_bound(events_, event.time_ns, {}, &Event::time_ns), event);
}

void GuardLab::take_commits() {
  for (auto& commit : guard_.take_commits()) {
    commits.push_back(commit.trajectory);
    in(kMessage_s, [this, committed = std::move(commit.trajectory)] {
      const auto status = tracker_.accept(committed, now_ns());
      if (!status) refusals.push_back(status.error());
      const Error outcome = status ? Error{ErrorCode::ok, ""} : status.error();
      in(kMessage_s,
         [this, id = committed.id(), outcome] { guard_.on_tracker_answer(id, outcome, now_ns()); });
    });
  }
}

void GuardLab::step() {
  const std::int64_t now = now_ns();
  while (!events_.empty() && events_.front().time_ns <= now) {
    const auto act = std::move(events_.front().act);
    events_.pop_front();
    act();
  }
  if (now % (100 * kMillisecond) == 0 && world_.see_from(position())) {
    tracker_.set_map(world_.map(), now);
    guard_.set_map(world_.map(), now);
    take_commits();
  }
  if (now % (4 * kMillisecond) == 0) control(now);
  const Vec3 before = position();
  if (auto status = vehicle_.advance(0.001); !status) {
    throw std::logic_error(status.error().message);
  }
  travelled_m += (position() - before).norm();
  max_speed_m_s = std::max(max_speed_m_s, velocity().norm());
  if (now % (10 * kMillisecond) != 0) return;
  const auto& state = vehicle_.state();
  track_.push_back({double(now_ns()) * 1e-9, state.position_map, state.q_map_base.normalized()});
}

void GuardLab::control(std::int64_t now_ns) {
  const auto measured = vehicle_.measure();
  if (guard_.flown().newest(now_ns) == nullptr) {
    guard_.on_heading(yaw_of(measured.state.q_map_base));
  }
  tracker_.heard_navigator(now_ns);
  if (const auto command = tracker_.step(measured.state, measured.time_ns, now_ns)) {
    if (auto status = vehicle_.command(*command); !status) {
      throw std::logic_error(status.error().message);
    }
  }
  const auto status = tracker_.status();
  max_error_m = std::max(max_error_m, status.error_m);
  guard_.on_tracking(tracking_of(status), now_ns);
  if (status.lost_trajectory_id == lost_id_) return;
  lost_id_ = status.lost_trajectory_id;
  if (lost_id_ == 0) return;
  losses.push_back(status.fault);
  in(kMessage_s, [this, id = lost_id_, fault = status.fault] {
    guard_.on_tracker_answer(id, fault, this->now_ns());
  });
}

flight_check::Verdict GuardLab::judge() const {
  const auto check = flight_check::FlightCheck::from_tree(tree_of(world_.truth()));
  if (!check) throw std::logic_error(check.error().message);
  const auto verdict = check->judge(track_, 1.0);
  if (!verdict) throw std::logic_error(verdict.error().message);
  return *verdict;
}

}  // namespace goshawk::guarded
