#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "goshawk/tracker/commit_gate.hpp"
#include "goshawk/tracker/tracker.hpp"
#include "trajectories.hpp"

// Whatever passes the conversions of messages may reach the tracker: absurd numbers, orders and
// times. Nothing of it makes it throw, command what is not finite or beyond its bounds, or fly
// through what its map shows blocked.

namespace goshawk::tracker {
namespace {

class Hostile {
 public:
  explicit Hostile(std::uint64_t seed) : random_(seed) {
    config_.second_opinion = random_.chance(0.3) ? SecondOpinion::require : SecondOpinion::heed;
    config_.controller = random_.chance(0.5) ? "pd" : "geometric";
    config_.require_map = random_.chance(0.7);
    tracker_.emplace(Tracker::create(config_).value());
    gate_.emplace(config_);
  }

  void run(int calls) {
    for (int k = 0; k < calls; ++k) {
      pass_time();
      switch (random_.below(8)) {
        case 0:
          return_commit();
          break;
        case 1:
          tracker_->set_map(map(), now_ns_);
          break;
        case 2:
          say(random_.below(30));
          break;
        case 3:
          tracker_->heard_navigator(now_ns_);
          tracker_->watch(now_ns_);
          break;
        default:
          step();
      }
      if (random_.chance(0.01)) tracker_->brake(now_ns_);
    }
  }
  int accepted = 0;
  int commands = 0;

 private:
  /// Mostly a sensible number, at times an absurd one.
  double number(double size) {
    if (random_.chance(0.97)) return random_.uniform(-size, size);
    const double sign = random_.chance(0.5) ? 1.0 : -1.0;
    return sign * std::pow(10.0, random_.uniform(-300.0, 300.0));
  }
  Vec3 vector(double size) { return {number(size), number(size), number(size)}; }

  void pass_time() {
    const double jump_s = random_.chance(0.01) ? std::clamp(number(20.0), -1e9, 1e9) : 0.0;
    if (random_.chance(1e-3)) now_ns_ = std::int64_t(random_.next() / 4);  // beyond all clocks
    if (now_ns_ > 4'100'000'000'000'000'000) now_ns_ = 1'000'000'000;
    now_ns_ += std::int64_t(1e9 * jump_s) + random_.below(8'000'000);
  }

  void step() {
    RigidBodyState state;
    const bool is_true = random_.chance(0.9);
    const FlatState wanted = tracker_->status().reference;
    state.position_map = is_true ? wanted.position : vector(5.0);
    state.velocity_map = is_true ? wanted.velocity : vector(3.0);
    state.angular_velocity_base = vector(1.0);
    if (random_.chance(0.1)) {
      state.q_map_base = Quaternion(number(1.0), number(1.0), number(1.0), number(1.0));
      if (random_.chance(0.9)) state.q_map_base.normalize();
    }
    std::int64_t stamp_ns = now_ns_ - random_.below(3'000'000);
    if (random_.chance(0.02)) stamp_ns = std::int64_t(random_.next());
    const auto command = tracker_->step(state, stamp_ns, now_ns_);
    if (!command) return;
    ++commands;
    EXPECT_GE(command->thrust_n, 0.99 * config_.min_thrust_n);
    EXPECT_LE(command->thrust_n, 1.01 * config_.max_thrust_n);
    EXPECT_NEAR(command->q_map_base.norm(), 1.0, 1e-6);
    EXPECT_LE(command->angular_velocity_base.norm(), 1.01 * config_.max_body_rate_rad_s);
    const Vec3 up = command->q_map_base * Vec3::UnitZ();
    EXPECT_GE(up.z(), std::cos(config_.max_tilt_rad) - 1e-3);
  }

  std::shared_ptr<const VoxelGrid> map() {
    auto grid = std::make_shared<VoxelGrid>();
    grid->geometry = {.origin_map = vector(1.0) - Vec3::Constant(6.0),
                      .resolution_m = random_.chance(0.95) ? 0.4 : std::abs(number(1.0)) + 1e-300,
                      .size = {30, 30, 30}};
    grid->grown = BitGrid(grid->geometry.size, true, random_.chance(0.05));
    for (int k = random_.below(40); k > 0; --k) {
      grid->grown.set({random_.below(30), random_.below(30), random_.below(30)}, true);
    }
    grid->version = random_.chance(0.95) ? ++version_ : random_.next();
    if (!grid->check()) return map();
    map_ = grid;
    return grid;
  }

  /// From where the vehicle should be then, in a random number of pieces, to rest.
  std::optional<CommittedTrajectory> trajectory(std::int64_t start_ns) {
    Trajectory t;
    FlatState at = tracker_->status().reference;
    if (random_.chance(0.2)) at = {.position = vector(3.0), .velocity = vector(1.0)};
    const FlatState first = at;
    for (int k = 1 + random_.below(4); k > 0; --k) {
      const FlatState next{.position = at.position + vector(2.0),
                           .velocity = k == 1 ? Vec3::Zero() : vector(0.5)};
      const double duration_s = random_.chance(0.97) ? random_.uniform(2.0, 5.0)
                                                     : std::abs(number(1.0)) + 1e-300;
      t.pieces.push_back(BezierPiece::between(at, next, duration_s));
      at = next;
    }
    auto certified = certify(t, {Polytope::box(Vec3::Constant(-1e6), Vec3::Constant(1e6))},
                             {.v_max_m_s = 1e9, .a_max_m_s2 = 1e9}, first, at);
    if (!certified) return {};
    auto made = CommittedTrajectory::make({.id = ++id_,
                                           .nominal = *std::move(certified),
                                           .start_time_ns = start_ns,
                                           .map_version = version_,
                                           .yaw_rad = number(3.0)});
    if (!made) return {};
    return *std::move(made);
  }

  void return_commit() {
    const std::int64_t start_ns =
        random_.chance(0.95) ? now_ns_ + random_.below(500'000'000) - 100'000'000
                             : std::int64_t(random_.next());
    auto made = trajectory(start_ns);
    if (!made) return;
    gate_->put({*std::move(made), start_ns, now_ns_});
    if (config_.second_opinion == SecondOpinion::require) gate_->hear(id_, {ErrorCode::ok, ""});
    auto release = gate_->release(true, tracker_->map_version(), now_ns_);
    if (!release || !release->verdict) return;
    const CommittedTrajectory committed = release->commit.trajectory;
    if (!tracker_->accept(committed, start_ns, now_ns_)) return;
    ++accepted;
    if (!map_) return;
    // Independently: no point of it lies well inside a blocked voxel.
    const double from_s = std::max(0.0, double(now_ns_ - start_ns) * 1e-9);
    const double to_s = committed.flown().duration_s();
    for (int i = 0; i <= 300; ++i) {
      const Vec3 p = committed.flown().sample(from_s + (to_s - from_s) * i / 300.0).position;
      EXPECT_FALSE(is_deep_inside(p)) << to_text(p);
    }
  }

  bool is_deep_inside(const Vec3& p) const {
    const Vec3 g = map_->geometry.to_grid(p);
    const double deep = 1e-4 / map_->geometry.resolution_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(g[axis] - std::round(g[axis])) < deep) return false;
    }
    const auto voxel = map_->geometry.index_of(p);
    return !voxel || map_->grown.get(*voxel);
  }

  void say(int what) {
    const std::uint64_t id = what < 10 ? id_ : random_.next();
    const ErrorCode code = what < 3 ? ErrorCode::collision : ErrorCode::ok;
    gate_->hear(id, {code, "a verdict"});
    if (code == ErrorCode::collision) tracker_->veto(id, "a verdict", now_ns_);
  }

  Random random_;
  Config config_;
  std::optional<Tracker> tracker_;
  std::optional<CommitGate> gate_;
  std::shared_ptr<const VoxelGrid> map_;
  std::int64_t now_ns_ = 1'000'000'000;
  std::uint64_t version_ = 0;
  std::uint64_t id_ = 0;
};

TEST(HostileInput, NeitherThrowsNorCommandsBeyondTheBoundsNorCrossesTheMap) {
  int accepted = 0, commands = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Hostile hostile(seed);
    ASSERT_NO_THROW(hostile.run(800));
    accepted += hostile.accepted;
    commands += hostile.commands;
    if (testing::Test::HasFailure()) return;
  }
  std::printf("%d trajectories accepted, %d commands\n", accepted, commands);
  EXPECT_GT(accepted, 100);
  EXPECT_GT(commands, 3'000);
}

}  // namespace
}  // namespace goshawk::tracker
