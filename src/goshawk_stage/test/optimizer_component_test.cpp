#include "goshawk/stage/optimizer_component.hpp"

#include <gmock/gmock.h>

#include <concepts>
#include <type_traits>

#include "two_nodes.hpp"

namespace goshawk::stage {
namespace {

namespace msg = goshawk_msgs::msg;

struct NoParameters {};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, NoParameters>
void describe(Self&, Visitor&&) {}

/// Finds nothing, and says whether there was time to.
struct Hurried {
  struct Solution {
    CertifiedTrajectory certified;
    std::optional<YawCurve> yaw;
    int iterations;
    double jerk_cost;
    const Trajectory& trajectory() const { return certified.trajectory(); }
  };

  static Result<Hurried> create(const NoParameters&) { return Hurried{}; }
  Status reconfigure(const NoParameters&) { return success(); }
  std::string_view implementation() const { return "hurried"; }
  Result<Solution> optimise(const PlanRequest&, const Corridor&,
                            const std::function<bool()>& out_of_time = {}) const {
    if (out_of_time()) return fail(ErrorCode::deadline_exceeded, "no time was left");
    return fail(ErrorCode::solver_failed, "there was time");
  }
};

class Optimizers : public testing::Test {
 protected:
  Optimizers() {
    // As on a machine: the clock for stamps is far from the one that counts durations.
    nodes_.clock->set(1);
    nodes_.clock->step_wall_clock(std::int64_t{1} << 60);
    nodes_.other.subscribe<msg::StageReport>(
        "stage_report", runtime::Qos::latched(20),
        [this](const msg::StageReport& m, const auto&) { reports_.push_back(m); });
  }

  msg::Corridor corridor(std::uint64_t id, double deadline_s) const {
    PlanRequest request;
    request.id = id;
    request.limits = {1.0, 1.0};
    request.deadline_s = deadline_s;
    msg::Corridor m;
    m.request(conversions::to_msg(request));
    m.polytopes(
        conversions::to_msg(std::vector{Polytope::box(Vec3::Constant(-1.0), Vec3::Constant(1.0))}));
    m.header(conversions::make_header(nodes_.clock->now_ns()));
    return m;
  }

  /// @return the code of the report of a request
  std::string answer(std::uint64_t id) {
    const auto of_id = [id](const msg::StageReport& r) { return r.request_id() == id; };
    nodes_.spin_until([&] { return std::ranges::any_of(reports_, of_id); });
    const auto found = std::ranges::find_if(reports_, of_id);
    return found == reports_.end() ? "silence" : found->code();
  }

  stage_test::TwoNodes nodes_;
  std::vector<msg::StageReport> reports_;
};

TEST_F(Optimizers, HaveTheWholeDeadlineHoweverFarApartTheClocksAre) {
  const OptimizerComponent<Hurried, NoParameters> component(nodes_.stage);
  const auto corridors =
      nodes_.other.advertise<msg::Corridor>("corridor", runtime::Qos::reliable_last());
  ASSERT_TRUE(nodes_.spin_until([&] { return corridors.matched() > 0; }));
  // A busy machine may take the message out late, which counts: the deadline is far.
  ASSERT_TRUE(corridors.publish(corridor(1, 600.0)));
  EXPECT_EQ(answer(1), "solver_failed");
  ASSERT_TRUE(corridors.publish(corridor(2, 1e-9)));
  ASSERT_TRUE(corridors.wait_acknowledged(60.0));
  nodes_.clock->advance(1'000'000'000);
  EXPECT_EQ(answer(2), "deadline_exceeded");
}

}  // namespace
}  // namespace goshawk::stage
