// goshawk bench guard: what it costs to make another planner's plan safe.
#include "goshawk/guard/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>

#include "common/measure.hpp"
#include "common/report.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::bench {
namespace {

constexpr double kResolution_m = 0.2, kInflation_m = 0.2;
constexpr double kHorizon_m = 8.0, kSpacing_m = 0.4, kSpeed_m_s = 0.7;
constexpr std::int64_t kSecond = 1'000'000'000;

std::shared_ptr<const VoxelGrid> forest(std::uint64_t seed) {
  worlds::WorldSpec spec;
  spec.kind = "forest";
  spec.size_m = Vec3(30.0, 30.0, 4.0);
  spec.density = 0.1;
  spec.seed = seed;
  const auto world = worlds::make_world(spec).value();
  return std::make_shared<const VoxelGrid>(
      VoxelGrid{.geometry = world.geometry,
                .grown = inflate(world.occupied, kInflation_m, kResolution_m).value(),
                .known = {},
                .raw = world.occupied,
                .version = 1,
                .inflation_m = kInflation_m});
}

/// The first metres of a path, evenly spaced.
std::vector<Vec3> horizon(const std::vector<Vec3>& path) {
  std::vector<Vec3> points{path.front()};
  double left_m = kHorizon_m;
  for (std::size_t i = 0; i + 1 < path.size() && left_m > 0.0; ++i) {
    const Vec3 way = path[i + 1] - path[i];
    const double length_m = std::min(way.norm(), left_m);
    const int steps = std::max(1, int(length_m / kSpacing_m));
    for (int k = 1; k <= steps; ++k) {
      points.push_back(path[i] + length_m * k / steps * way.normalized());
    }
    left_m -= length_m;
  }
  return points;
}

guard::Plan spline(const std::vector<Vec3>& points, double speed_m_s) {
  guard::Bspline s{.degree = 3};
  for (int i = 0; i < 2; ++i) s.control_points_map.push_back(points.front());
  s.control_points_map.insert(s.control_points_map.end(), points.begin(), points.end());
  for (int i = 0; i < 2; ++i) s.control_points_map.push_back(points.back());
  for (std::size_t i = 0; i < s.control_points_map.size() + 4; ++i) {
    s.knots_s.push_back(kSpacing_m / speed_m_s * double(i));
  }
  return {.kind = guard::PlanKind::bspline, .shape = std::move(s)};
}

guard::Plan polynomial(const std::vector<Vec3>& points) {
  const auto curve = guard::curve_of(std::get<guard::Bspline>(spline(points, kSpeed_m_s).shape));
  guard::Polynomials p;
  for (const BezierPiece& piece : curve->trajectory.pieces) {
    const FlatState s = piece.sample(0.0);
    guard::Polynomials::Piece cubic{.duration_s = piece.duration_s, .coefficients = {}};
    for (int axis = 0; axis < 3; ++axis) {
      cubic.coefficients[std::size_t(axis)] = {s.position[axis], s.velocity[axis],
                                               s.acceleration[axis] / 2.0, s.jerk[axis] / 6.0};
    }
    p.pieces.push_back(std::move(cubic));
  }
  return {.kind = guard::PlanKind::polynomial, .shape = std::move(p)};
}

guard::Plan trajectory(const std::vector<Vec3>& points) {
  const auto curve = guard::curve_of(std::get<guard::Bspline>(spline(points, kSpeed_m_s).shape));
  guard::Samples samples;
  const double duration_s = curve->trajectory.duration_s();
  const int steps = int(duration_s / 0.05);
  for (int i = 0; i <= steps; ++i) {
    const double t_s = duration_s * i / steps;
    const FlatState s = curve->trajectory.sample(t_s);
    samples.samples.push_back({t_s, s.position, s.velocity, s.acceleration});
  }
  return {.kind = guard::PlanKind::trajectory, .shape = std::move(samples)};
}

struct Measured {
  std::vector<double> us = {};
  std::array<int, 4> verdicts = {};
  int trimmed = 0;
};

/// A guard whose vehicle hovers, or flies a plan, at the start of each plan.
class Bench {
 public:
  explicit Bench(const std::shared_ptr<const VoxelGrid>& map) {
    guard_.set_map(map, now_);
    guard_.on_heading(0.0);
  }

  void hover(const Vec3& p_map) {
    now_ += 100 * kSecond;
    guard_.on_tracking({guard::Tracking::Mode::brakes, p_map}, now_);
    guard_.on_tracking({guard::Tracking::Mode::holds, p_map}, now_);
  }

  void send(const guard::Plan& plan, Measured& measured) {
    guard::Decision decision;
    measured.us.push_back(
        time_us([&] { decision = guard_.on_plan(plan, now_); }, Clock::processor));
    ++measured.verdicts[std::size_t(decision.verdict)];
    measured.trimmed += decision.trimmed ? 1 : 0;
    for (const auto& commit : guard_.take_commits()) {
      guard_.on_tracker_answer(commit.trajectory.id(), {ErrorCode::ok, ""}, now_);
    }
  }

  /// In flight: again and again from a little beside the state that the vehicle has.
  void replan(const std::vector<Vec3>& points, Random& random, Measured& measured) {
    Measured first;
    send(spline(points, kSpeed_m_s), first);
    now_ += kSecond;
    for (int i = 0; i < 8; ++i) {
      now_ += kSecond / 5;
      const auto state = guard_.flown().at(now_);
      if (!state || state->velocity.norm() < 0.1) return;
      guard_.on_tracking({guard::Tracking::Mode::follows, state->position}, now_);
      const Vec3 off(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.0);
      std::vector<Vec3> left{state->position};
      std::size_t k = 0;
      const auto farther = [&](const Vec3& p) { return (p - state->position).norm() > 1.0; };
      while (k < points.size() && !farther(points[k])) ++k;
      for (; k < points.size(); ++k) left.push_back(points[k] + off);
      send(spline(left, kSpeed_m_s), measured);
    }
  }

 private:
  guard::Guard guard_{{}, guard::make_repair(), 1};
  std::int64_t now_ = 100 * kSecond;
};

void add(Report& report, const char* plan, const Measured& measured) {
  std::vector<double> sorted = measured.us;
  std::ranges::sort(sorted);
  report.add({{"table", "guard"},
              {"plan", plan},
              {"plans", sorted.size()},
              {"p50_ms", at_share(sorted, 0.5) * 1e-3},
              {"p99_ms", at_share(sorted, 0.99) * 1e-3},
              {"worst_ms", sorted.empty() ? 0.0 : sorted.back() * 1e-3},
              {"passed", measured.verdicts[0]},
              {"slowed", measured.verdicts[1]},
              {"replaced", measured.verdicts[2]},
              {"refused", measured.verdicts[3]},
              {"trimmed", measured.trimmed}});
}

Vec3 random_place(const VoxelGrid& map, Random& random) {
  const Index3 size = map.geometry.size;
  while (true) {
    const Index3 i{random.below(size.x), random.below(size.y), random.below(size.z)};
    if (!map.grown.test(i)) return map.geometry.center(i);
  }
}

void run(Report& report) {
  const bool quick = report.options().quick;
  Measured exact, cubic, sampled, fast, flying, blind, path;
  for (std::uint64_t seed = 1; seed <= (quick ? 1U : 5U); ++seed) {
    report.progress(fmt::format("forest {}", seed));
    const auto map = forest(seed);
    auto search = path_search::PathSearch::create({}).value();
    search.set_map(map);
    Bench bench(map);
    Random random(seed);
    for (int i = 0; i < (quick ? 40 : 200); ++i) {
      const Vec3 from = random_place(*map, random), to = random_place(*map, random);
      const auto found = search.plan(from, to);
      if (!found || (to - from).norm() < 2.0) continue;
      const auto points = horizon(found->waypoints_map);
      const auto from_rest = [&](const guard::Plan& plan, Measured& measured) {
        bench.hover(from);
        bench.send(plan, measured);
      };
      from_rest(spline(points, kSpeed_m_s), exact);
      from_rest(polynomial(points), cubic);
      from_rest(trajectory(points), sampled);
      from_rest(spline(points, 6.0), fast);
      from_rest(spline(horizon({from, to}), kSpeed_m_s), blind);
      from_rest({.kind = guard::PlanKind::path, .shape = guard::Waypoints{points}}, path);
      bench.hover(from);
      bench.replan(points, random, flying);
    }
  }
  add(report, "B-spline", exact);
  add(report, "polynomials", cubic);
  add(report, "trajectory, 20 Hz", sampled);
  add(report, "B-spline, too fast", fast);
  add(report, "B-spline, blind", blind);
  add(report, "B-spline, in flight, 0.1 m beside", flying);
  add(report, "path without times", path);
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "guard", goshawk::bench::run);
}
