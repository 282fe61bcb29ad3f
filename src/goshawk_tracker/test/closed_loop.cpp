#include "closed_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace goshawk::tracker {
namespace {

constexpr std::int64_t kFallbackPeriod_ns = 50'000'000;
constexpr std::size_t kSocketHolds = 100;  // messages; later ones are dropped

}  // namespace

ClosedLoop::ClosedLoop(const Config& tracker_config, const simulator::Config& vehicle_config,
                       Link with_link)
    : vehicle(simulator::Quadrotor::create(vehicle_config).value()),
      tracker(Tracker::create(without_map(tracker_config)).value()),
      link(std::move(with_link)) {}

void ClosedLoop::run_until(std::int64_t end_ns, const std::function<void()>& each) {
  while (now_ns() < end_ns) {
    exchange();
    ASSERT_TRUE(vehicle.advance(0.001));
    if (vehicle.control() == simulator::Control::failsafe) ++failsafe_ms;
    if (each) each();
  }
}

void ClosedLoop::stop_everything(double pause_s, double world_s) {
  kept_.push_back(measure());
  ASSERT_TRUE(vehicle.advance(world_s));
  paused_ns_ += std::llround((pause_s - world_s) * 1e9);
}

simulator::Measurement ClosedLoop::measure() {
  auto measured = vehicle.measure();
  measured.time_ns += paused_ns_;
  return measured;
}

void ClosedLoop::exchange() {
  const std::int64_t now = now_ns();
  if (now >= next_odometry_ns_) {
    next_odometry_ns_ = now + (link.gap_ns ? link.gap_ns() : link.period_ns);
    if (now < stalled_until_ns) {
      if (kept_.size() < kSocketHolds) kept_.push_back(measure());
    } else {
      if (watched) tracker.watch(now);
      for (; !kept_.empty(); kept_.pop_front()) take(kept_.front(), now);
      if (connected) take(measure(), now);
    }
  }
  for (; !arrivals_.empty() && arrivals_.front().time_ns <= now; arrivals_.pop_front()) {
    ASSERT_TRUE(vehicle.command(arrivals_.front().command));
  }
}

void ClosedLoop::take(const simulator::Measurement& measured, std::int64_t now) {
  RigidBodyState state = measured.state;
  if (link.spoil) link.spoil(state);
  const auto command = tracker.step(state, measured.time_ns, now + link.odometry_delay_ns);
  if (!command) {
    last_error = command.error();
  } else if (!link.drop || !link.drop()) {
    arrivals_.push_back({now + link.odometry_delay_ns + link.command_delay_ns, *command});
  }
  give_fallback(now);
}

// One that does not pass the vehicle is refused by it: that is what the upsets are about.
void ClosedLoop::give_fallback(std::int64_t now) {
  const auto status = tracker.status();
  const std::uint64_t id = status.trajectory_id ^ status.lost_trajectory_id;
  if (now < next_fallback_ns_ && id == fallback_for_) return;
  if (!tracker.make_fallback(fallback_, now + link.odometry_delay_ns)) return;
  next_fallback_ns_ = now + kFallbackPeriod_ns;
  fallback_for_ = id;
  ASSERT_TRUE(fallback_.check()) << fallback_.check().error().message;
  if (const Status given = vehicle.set_fallback(fallback_); !given) {
    ASSERT_EQ(given.code(), ErrorCode::not_at_start);
  }
}

ClosedLoop::Errors ClosedLoop::fly(Draft committed, double rest_s) {
  const auto accepted = tracker.accept(committed, vehicle.time_ns());
  EXPECT_TRUE(accepted) << accepted.error().message;
  const double duration = committed.trajectory.duration_s();
  const auto start = committed.start_time_ns;
  Errors errors;
  double squares = 0.0;
  int count = 0;
  run_until(start + std::llround((duration + rest_s) * 1e9), [&] {
    const double t = double(vehicle.time_ns() - start) * 1e-9;
    if (t < 0.0) return;
    const auto wanted = committed.trajectory.sample(std::min(t, duration));
    errors.final_m = (vehicle.state().position_map - wanted.position).norm();
    errors.max_m = std::max(errors.max_m, errors.final_m);
    squares += errors.final_m * errors.final_m;
    ++count;
  });
  errors.rms_m = std::sqrt(squares / std::max(1, count));
  return errors;
}

}  // namespace goshawk::tracker
