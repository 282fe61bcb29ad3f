#include "goshawk/conformance/conform.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "goshawk/path_search/config.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/stage/intake.hpp"
#include "goshawk/stage/map_subscription.hpp"
#include "support.hpp"

namespace goshawk::conformance {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;
using conformance_test::failed;
using conformance_test::join;
using testing::ElementsAre;
using testing::IsEmpty;

enum class Fault { none, silent, wrong_echo, through_walls, believes_all, says_nothing, moody };

/// A search stage as somebody else might write it, with one fault.
class ForeignSearch {
 public:
  ForeignSearch(Node& node, Fault fault)
      : node_(node),
        fault_(fault),
        search_(*path_search::PathSearch::create({})),
        reporter_(node, StageRole::path_search, "foreign"),
        publisher_(node.advertise<msg::Path>("path", Qos::reliable_last())),
        map_(node, reporter_, [this](const auto& grid) { search_.set_map(grid); }) {
    node.subscribe<msg::PlanRequest>("plan_request", Qos::reliable_last(),
                                     [this](const auto& m, const auto& info) { on(m, info); });
    reporter_.ready("here");
  }

 private:
  void on(const msg::PlanRequest& m, const MessageInfo& info) {
    ++requests_;
    if (fault_ == Fault::silent && requests_ % 5 == 0) return;
    if (fault_ == Fault::believes_all) return answer(m, {Vec3(0, 0, 0), Vec3(1, 0, 0)});
    const std::int64_t arrived_ns = node_.monotonic_ns() - info.waited_ns;
    const auto request = open_request(m, arrived_ns, node_.monotonic_ns(), reporter_, {});
    if (!request) return;
    const Vec3& start = request->start.position;
    const Vec3& goal = request->goal.position;
    auto path = search_.plan(start, goal);
    if (!path) return reporter_.failed(m.id(), path.error());
    answer(m,
           fault_ == Fault::through_walls ? std::vector<Vec3>{start, goal} : path->waypoints_map);
  }

  void answer(msg::PlanRequest request, const std::vector<Vec3>& waypoints) {
    msg::Path m;
    const std::uint64_t id = request.id();
    if (fault_ == Fault::wrong_echo) request.goal_yaw(0.0);
    m.request(request);
    m.implementation("foreign");
    m.map_version(map_.grid() == nullptr ? 0 : map_.grid()->version);
    m.waypoints(conversions::to_points(waypoints));
    if (fault_ == Fault::moody) m.cost(requests_);
    m.header(conversions::make_header(node_.now_ns()));
    (void)publisher_.publish(m);
    if (fault_ != Fault::says_nothing) reporter_.answered(id, {});
  }

  Node& node_;
  Fault fault_;
  int requests_ = 0;
  path_search::PathSearch search_;
  StageReporter reporter_;
  Publisher<msg::Path> publisher_;
  MapSubscription map_;
};

constexpr std::size_t kFaults = std::size_t(Fault::moody) + 1;

/// What must be waited for in vain costs the whole time of it, so that it is short there; all else
/// comes in its own time, on whatever machine.
conformance::Options options_for(Fault fault) {
  const bool in_vain = fault == Fault::silent || fault == Fault::says_nothing;
  return {.stage = "path_search",
          .requests = 20,
          .timeout_s = in_vain ? 0.25 : 10.0,
          .ready_timeout_s = 20.0};
}

/// All were examined at once, at the first call: they wait most of the time.
const Report& examine(Fault fault) {
  static const std::vector<Report> reports = [] {
    std::vector<Report> all(kFaults);
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < kFaults; ++k) {
      threads.emplace_back([&all, k] {
        all[k] = conformance_test::examine<ForeignSearch>(options_for(Fault(k)), Fault(k));
      });
    }
    for (auto& thread : threads) thread.join();
    return all;
  }();
  return reports[std::size_t(fault)];
}

TEST(Conform, StageWithoutFaultPassesEveryItem) {
  const Report report = examine(Fault::none);
  EXPECT_THAT(failed(report), IsEmpty());
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.implementation, "foreign");
  EXPECT_GT(report.items.size(), 15U);
  EXPECT_GT(report.latency_p50_s, 0.0);
  EXPECT_LE(report.latency_p50_s, report.latency_max_s);
}

TEST(Conform, SilentStageFailsToAnswer) {
  EXPECT_THAT(failed(examine(Fault::silent)), testing::Contains("answers every request"));
}

TEST(Conform, ChangedRequestFailsTheEchoAlone) {
  EXPECT_THAT(failed(examine(Fault::wrong_echo)), ElementsAre("echoes the request whole"));
}

TEST(Conform, PathThroughWallsIsNotValid) {
  EXPECT_THAT(failed(examine(Fault::through_walls)), ElementsAre("results are valid"));
}

TEST(Conform, StageThatBelievesAllFailsEveryBadRequest) {
  const Report report = examine(Fault::believes_all);
  for (const auto& item : report.items) {
    const bool about_bad = item.name.starts_with("refuses");
    if (about_bad || item.name == "results are valid") {
      EXPECT_FALSE(item.passed) << item.name;
    } else {
      EXPECT_TRUE(item.passed) << item.name << ": " << item.detail;
    }
  }
}

TEST(Conform, ResultsWithoutReportsAreNamed) {
  EXPECT_THAT(failed(examine(Fault::says_nothing)), testing::Contains("reports every result"));
}

TEST(Conform, StageThatAnswersOtherwiseTheSecondTimeIsNamed) {
  EXPECT_THAT(failed(examine(Fault::moody)), ElementsAre("gives the same answer twice"));
}

TEST(Conform, NobodyThereIsAnError) {
  const auto ours = join(runtime::hold_private_domain().value());
  const auto report = conform(*ours, {.stage = "path_search", .ready_timeout_s = 0.3});
  ASSERT_FALSE(report.ok());
  EXPECT_EQ(report.code(), ErrorCode::stage_silent);
  EXPECT_EQ(conform(*ours, {.stage = "path_serch"}).code(), ErrorCode::invalid_parameter);
}

}  // namespace
}  // namespace goshawk::conformance
