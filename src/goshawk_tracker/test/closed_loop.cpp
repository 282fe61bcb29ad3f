#include "closed_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace goshawk::tracker {
namespace {

template <typename Points>
double largest(const Points& points) {
  return points.colwise().norm().maxCoeff();
}

}  // namespace

void certify_as_is(CommittedTrajectory& c) {
  c.polytopes = {Polytope::box(Vec3::Constant(-100.0), Vec3::Constant(100.0))};
  c.limits = {0.0, 0.0};
  for (const auto& piece : c.trajectory.pieces) {
    c.limits.v_max_m_s = std::max(c.limits.v_max_m_s, largest(piece.velocity_points()));
    c.limits.a_max_m_s2 = std::max(c.limits.a_max_m_s2, largest(piece.acceleration_points()));
  }
  c.start = c.trajectory.pieces.front().sample(0.0);
  c.goal = c.trajectory.pieces.back().sample(c.trajectory.pieces.back().duration_s);
}

CommittedTrajectory random_trajectory(Random& random, const Vec3& start, int pieces,
                                      double v_max_m_s, double a_max_m_s2) {
  std::vector<FlatState> joints(std::size_t(pieces) + 1);
  std::vector<double> durations;
  joints[0].position = start;
  for (std::size_t k = 1; k < joints.size(); ++k) {
    joints[k].position = joints[k - 1].position + Vec3(random.uniform(-1.5, 1.5),
                                                       random.uniform(0.5, 2.0),
                                                       random.uniform(-0.5, 0.5));
    durations.push_back((joints[k].position - joints[k - 1].position).norm());
  }
  for (std::size_t k = 1; k + 1 < joints.size(); ++k) {
    joints[k].velocity = (joints[k + 1].position - joints[k - 1].position) /
                         (durations[k - 1] + durations[k]);
    joints[k].acceleration = Vec3(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), 0.0);
  }
  const auto build = [&](double scale) {  // time runs `scale` times slower
    Trajectory trajectory;
    for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
      FlatState a = joints[k], b = joints[k + 1];
      for (FlatState* s : {&a, &b}) {
        s->velocity /= scale;
        s->acceleration /= scale * scale;
      }
      trajectory.pieces.push_back(BezierPiece::between(a, b, scale * durations[k]));
    }
    return trajectory;
  };
  const auto peaks = build(1.0).peaks();
  CommittedTrajectory c;
  c.id = random.next();
  c.trajectory = build(std::max(peaks.speed_m_s / v_max_m_s,
                                std::sqrt(peaks.acceleration_m_s2 / a_max_m_s2)));
  certify_as_is(c);
  return c;
}

CommittedTrajectory straight_line(const Vec3& start, const Vec3& end, double duration_s) {
  CommittedTrajectory c;
  c.id = 1;
  c.trajectory.pieces = {BezierPiece::between({.position = start}, {.position = end}, duration_s)};
  certify_as_is(c);
  return c;
}

ClosedLoop::ClosedLoop(const Config& tracker_config, const simulator::Config& vehicle_config,
                       Link link)
    : vehicle(simulator::Quadrotor::create(vehicle_config).value()),
      tracker(Tracker::create(tracker_config).value()),
      link_(std::move(link)) {}

void ClosedLoop::run_until(std::int64_t end_ns, const std::function<void()>& each) {
  while (vehicle.time_ns() < end_ns) {
    exchange();
    ASSERT_TRUE(vehicle.advance(0.001));
    if (vehicle.control() == simulator::Control::failsafe) ++failsafe_ms;
    if (each) each();
  }
}

void ClosedLoop::exchange() {
  const std::int64_t now = vehicle.time_ns();
  if (now >= next_odometry_ns_) {
    next_odometry_ns_ = now + (link_.gap_ns ? link_.gap_ns() : link_.period_ns);
    if (connected) {
      const auto command = tracker.step(vehicle.state(), now, now + link_.odometry_delay_ns);
      if (!command) {
        last_error = command.error();
      } else if (!link_.drop || !link_.drop()) {
        arrivals_.push_back({now + link_.odometry_delay_ns + link_.command_delay_ns, *command});
      }
    }
  }
  for (; !arrivals_.empty() && arrivals_.front().time_ns <= now; arrivals_.pop_front()) {
    ASSERT_TRUE(vehicle.command(arrivals_.front().command));
  }
}

ClosedLoop::Errors ClosedLoop::fly(CommittedTrajectory committed, double rest_s) {
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
