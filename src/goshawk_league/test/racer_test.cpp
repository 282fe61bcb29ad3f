#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "goshawk/core/random.hpp"
#include "goshawk/league/settings.hpp"
#include "goshawk/tracker/position_controller.hpp"

namespace goshawk::league {
namespace {

constexpr double kStep_s = 0.001;
constexpr int kControl = 4;        // steps from one command to the next
constexpr double kFast_m_s = 5.0;  // on each axis

/// What the planning stages may ask of the racer.
bool may_be_asked(const FlatState& s, const closed_loop::Setup& racer) {
  const auto& optimizer = racer.planning.optimizer;
  const Vec3 force = s.acceleration + Vec3(0.0, 0.0, kGravity_m_s2);
  return s.acceleration.cwiseAbs().maxCoeff() <= racer.navigator.a_max_m_s2 &&
         s.velocity.cwiseAbs().maxCoeff() <= kFast_m_s && force.z() >= optimizer.min_thrust_m_s2 &&
         force.norm() <= optimizer.max_thrust_m_s2 &&
         std::atan2(force.head<2>().norm(), force.z()) <= optimizer.max_tilt_rad;
}

FlatState after_a_step(const FlatState& s, const Vec3& jerk) {
  const double t = kStep_s;
  return {.position = s.position + t * (s.velocity + t / 2.0 * (s.acceleration + t / 3.0 * jerk)),
          .velocity = s.velocity + t * (s.acceleration + t / 2.0 * jerk),
          .acceleration = s.acceleration + t * jerk,
          .jerk = jerk};
}

/// Full jerk in ever other directions, as long as what it leads to may be asked for: harder than
/// any plan. At first at rest.
std::vector<FlatState> hardest_reference(const closed_loop::Setup& racer, Random& random) {
  const double most = racer.navigator.j_max_m_s3;
  std::vector<FlatState> reference(300, FlatState{});
  Vec3 jerk = Vec3::Zero();
  for (int left = 0; reference.size() < 15'000U; --left) {
    const FlatState& now = reference.back();
    if (left <= 0) {
      Vec3 towards(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      if (random.chance(0.5)) towards = 0.3 * towards - now.acceleration;
      jerk = most * towards.normalized();
      left = random.below(370) + 30;
    }
    // What the speed will be once the acceleration has faded must be allowed as well.
    FlatState next = after_a_step(now, jerk), later = next;
    later.velocity += next.acceleration.cwiseAbs().cwiseProduct(next.acceleration) / (1.1 * most);
    if (may_be_asked(next, racer) && may_be_asked(later, racer)) {
      reference.push_back(next);
      continue;
    }
    left = 0;
    const double fades_s = std::min(kStep_s, now.acceleration.norm() / most);
    next = after_a_step(now, Vec3::Zero());
    next.acceleration -= fades_s * most * now.acceleration.stableNormalized();
    if (now.acceleration.norm() < 1e-9) next.acceleration = -kStep_s * most * now.velocity / 10.0;
    reference.push_back(next);
  }
  return reference;
}

// With the inertia of a larger vehicle and a least thrust of 4 m/s^2, it left the reference for
// good in each of these flights: torque that the motors lack at little thrust.
TEST(Racer, KeepsNearWhateverItsLimitsLetPlansAskFor) {
  closed_loop::Setup racer;
  ASSERT_TRUE(apply_file(RACER, racer));
  const auto ahead = std::size_t(std::lround(racer.tracker.actuation_delay_s / kStep_s));
  Random random(7);
  for (int flight = 0; flight < 5; ++flight) {
    const auto reference = hardest_reference(racer, random);
    auto vehicle = simulator::Quadrotor::create(racer.vehicle).value();
    ASSERT_TRUE(vehicle.reset(Vec3::Zero(), 0.0));
    tracker::PositionController controller(racer.tracker);
    double worst_m = 0.0, fastest_m_s = 0.0;
    for (std::size_t k = 0; k + ahead < reference.size(); ++k) {
      if (k % kControl == 0) {
        const auto command = controller.step(vehicle.measure().state,
                                             {.now = reference[k], .ahead = reference[k + ahead]},
                                             k == 0 ? 0.0 : kControl * kStep_s);
        ASSERT_TRUE(vehicle.command(command));
      }
      worst_m = std::max(worst_m, (vehicle.state().position_map - reference[k].position).norm());
      fastest_m_s = std::max(fastest_m_s, reference[k].velocity.norm());
      ASSERT_TRUE(vehicle.advance(kStep_s));
    }
    EXPECT_LT(worst_m, 0.08) << "flight " << flight;
    EXPECT_GT(fastest_m_s, 2.0);
  }
}

}  // namespace
}  // namespace goshawk::league
