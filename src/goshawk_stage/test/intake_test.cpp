#include "goshawk/stage/intake.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

#include "two_nodes.hpp"

namespace goshawk::stage {
namespace {

namespace msg = goshawk_msgs::msg;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(SupersededRequests, NameTheNewerRequest) {
  SupersededRequests superseded;
  EXPECT_TRUE(superseded.check(1));
  superseded.note(2, 1);
  superseded.note(3, 0);  // supersedes none
  superseded.note(4, 4);  // nor can a request supersede itself
  const Status status = superseded.check(1);
  EXPECT_EQ(status.code(), ErrorCode::cancelled);
  EXPECT_THAT(status.error().message, AllOf(HasSubstr("request 1 "), HasSubstr("request 2 ")));
  for (const std::uint64_t id : {2, 3, 4}) EXPECT_TRUE(superseded.check(id)) << id;
}

TEST(SupersededRequests, ForgetTheOldestOnesFirst) {
  SupersededRequests superseded;
  for (std::uint64_t id = 1; id <= 1000; ++id) superseded.note(id + 1, id);
  EXPECT_FALSE(superseded.check(1000));
  EXPECT_FALSE(superseded.check(990));
  EXPECT_TRUE(superseded.check(1));
}

class Requests : public testing::Test {
 protected:
  Requests() {
    nodes_.clock->set(10 * kSecond);
    nodes_.other.subscribe<msg::StageReport>(
        "stage_report", runtime::Qos::latched(20),
        [this](const msg::StageReport& m, const auto&) { reports_.push_back(m); });
  }

  msg::PlanRequest request(std::uint64_t id, double deadline_s = 0.0) const {
    PlanRequest r;
    r.id = id;
    r.stamp_ns = nodes_.clock->now_ns();
    r.limits = {1.0, 1.0};
    r.deadline_s = deadline_s;
    return conversions::to_msg(r);
  }

  stage_test::TwoNodes nodes_;
  std::vector<msg::StageReport> reports_;
  StageReporter reporter_{nodes_.stage, StageRole::path_search, "method"};
  std::vector<std::uint64_t> taken_;
};

TEST_F(Requests, ThatAreGoodAreHandedOutInOrderAndTheOthersAreReported) {
  const Intake<msg::PlanRequest> intake(
      nodes_.stage, reporter_, "plan_request",
      [&](const msg::PlanRequest& m, const PlanRequest& r, Timing timing) {
        EXPECT_EQ(m.id(), r.id);
        EXPECT_EQ(timing.wire_ns, 2 * kSecond);
        taken_.push_back(r.id);
      });
  const auto requests =
      nodes_.other.advertise<msg::PlanRequest>("plan_request", runtime::Qos::reliable_last());
  ASSERT_TRUE(nodes_.spin_until([&] { return requests.matched() > 0; }));
  auto bad = request(2);
  bad.limits().v_max(-1.0);
  ASSERT_TRUE(requests.publish(request(1)));
  ASSERT_TRUE(requests.publish(bad));
  ASSERT_TRUE(requests.publish(request(3, 1e-9)));  // it has passed when the stage looks
  ASSERT_TRUE(requests.publish(request(4)));
  nodes_.clock->set(12 * kSecond);
  ASSERT_TRUE(nodes_.spin_until([&] { return taken_.size() + reports_.size() == 4; }));
  EXPECT_THAT(taken_, ElementsAre(1, 4));
  ASSERT_EQ(reports_.size(), 2U);
  EXPECT_EQ(reports_[0].request_id(), 2U);
  EXPECT_EQ(reports_[0].code(), "invalid_limits");
  EXPECT_EQ(reports_[1].request_id(), 3U);
  EXPECT_EQ(reports_[1].code(), "deadline_exceeded");
}

TEST_F(Requests, ThatANewerOneSupersedesAreDropped) {
  const Intake<msg::PlanRequest> intake(
      nodes_.stage, reporter_, "plan_request",
      [&](const msg::PlanRequest&, const PlanRequest& r, Timing) { taken_.push_back(r.id); });
  const auto requests =
      nodes_.other.advertise<msg::PlanRequest>("plan_request", runtime::Qos::reliable_last());
  ASSERT_TRUE(nodes_.spin_until([&] { return requests.matched() > 0; }));
  ASSERT_TRUE(requests.publish(request(1)));
  ASSERT_TRUE(requests.publish(request(2)));
  auto newer = request(3);
  newer.supersedes(1);
  ASSERT_TRUE(requests.publish(newer));
  ASSERT_TRUE(requests.wait_acknowledged(60.0));  // all are there before the stage looks
  ASSERT_TRUE(nodes_.spin_until([&] { return taken_.size() + reports_.size() == 3; }));
  EXPECT_THAT(taken_, ElementsAre(2, 3));
  ASSERT_EQ(reports_.size(), 1U);
  EXPECT_EQ(reports_[0].request_id(), 1U);
  EXPECT_EQ(reports_[0].code(), "cancelled");
  EXPECT_THAT(reports_[0].message(), HasSubstr("request 3 supersedes it"));
}

TEST_F(Requests, OfLaterStagesAreDroppedToo) {
  const Intake<msg::Path> intake(
      nodes_.stage, reporter_, "path",
      [&](const msg::Path&, const PlanRequest& r, Timing) { taken_.push_back(r.id); });
  const auto paths = nodes_.other.advertise<msg::Path>("path", runtime::Qos::reliable_last());
  const auto requests =
      nodes_.other.advertise<msg::PlanRequest>("plan_request", runtime::Qos::reliable_last());
  ASSERT_TRUE(nodes_.spin_until([&] { return paths.matched() > 0 && requests.matched() > 0; }));
  msg::Path path;
  path.request(request(1));
  ASSERT_TRUE(paths.publish(path));
  auto newer = request(2);
  newer.supersedes(1);
  ASSERT_TRUE(requests.publish(newer));
  ASSERT_TRUE(paths.wait_acknowledged(60.0) && requests.wait_acknowledged(60.0));
  ASSERT_TRUE(nodes_.spin_until([&] { return taken_.size() + reports_.size() == 1; }));
  EXPECT_THAT(taken_, testing::IsEmpty());
  EXPECT_EQ(reports_.at(0).code(), "cancelled");
}

TEST_F(Requests, InsideOtherMessagesAreTakenInWithThem) {
  const Intake<msg::Path> intake(nodes_.stage, reporter_, "path",
                                 [&](const msg::Path& m, const PlanRequest& r, Timing) {
                                   EXPECT_EQ(m.implementation(), "foreign");
                                   taken_.push_back(r.id);
                                 });
  const auto paths = nodes_.other.advertise<msg::Path>("path", runtime::Qos::reliable_last());
  ASSERT_TRUE(nodes_.spin_until([&] { return paths.matched() > 0; }));
  msg::Path path;
  path.request(request(5));
  path.implementation("foreign");
  ASSERT_TRUE(paths.publish(path));
  ASSERT_TRUE(nodes_.spin_until([&] { return !taken_.empty(); }));
  EXPECT_THAT(taken_, ElementsAre(5));
}

TEST(RequestArrivals, KeepTheFirstOfEachRequest) {
  RequestArrivals arrivals;
  msg::PlanRequest a;
  a.id(7);
  msg::PlanRequest of_another_asker = a;
  of_another_asker.header().stamp().sec(5);
  EXPECT_EQ(arrivals.note(a, 100), 100);
  EXPECT_EQ(arrivals.note(of_another_asker, 200), 200);
  EXPECT_EQ(arrivals.note(a, 300), 100);
  for (std::uint64_t id = 100; id < 200; ++id) {
    msg::PlanRequest other;
    other.id(id);
    arrivals.note(other, 400);
  }
  EXPECT_EQ(arrivals.note(a, 500), 500) << "memory is bounded: the oldest are forgotten";
}

// The asker's clock is of no account, and time counts from the first that is heard of a request.
TEST_F(Requests, HaveTheirDeadlineFromTheirArrivalWhateverTheAskersClockSays) {
  const Intake<msg::Path> intake(nodes_.stage, reporter_, "path",
                                 [&](const msg::Path&, const PlanRequest& r, Timing) {
                                   EXPECT_LT(std::abs(r.stamp_ns - 10 * kSecond), 600 * kSecond);
                                   taken_.push_back(r.id);
                                 });
  const auto paths = nodes_.other.advertise<msg::Path>("path", runtime::Qos::reliable_last());
  const auto requests =
      nodes_.other.advertise<msg::PlanRequest>("plan_request", runtime::Qos::reliable_last());
  ASSERT_TRUE(nodes_.spin_until([&] { return paths.matched() > 0 && requests.matched() > 0; }));
  const auto stamped = [&](std::uint64_t id, std::int64_t ahead_ns) {
    auto m = request(id, 60.0);
    m.header().stamp(conversions::to_stamp(10 * kSecond + ahead_ns));
    return m;
  };
  msg::Path ahead, behind, late;
  ahead.request(stamped(1, 3600 * kSecond));
  behind.request(stamped(2, -3600 * kSecond));
  late.request(stamped(3, 0));
  ASSERT_TRUE(requests.publish(late.request()));
  ASSERT_TRUE(requests.wait_acknowledged(60.0));
  nodes_.stage.spin_some(0.0);
  nodes_.clock->set(10 * kSecond);
  ASSERT_TRUE(paths.publish(ahead));
  ASSERT_TRUE(nodes_.spin_until([&] { return taken_.size() == 1; }));
  ASSERT_TRUE(paths.publish(behind));
  ASSERT_TRUE(nodes_.spin_until([&] { return taken_.size() == 2; }));
  nodes_.clock->set(71 * kSecond);
  ASSERT_TRUE(paths.publish(late));
  ASSERT_TRUE(nodes_.spin_until([&] { return !reports_.empty(); }));
  EXPECT_THAT(taken_, ElementsAre(1, 2));
  EXPECT_EQ(reports_[0].request_id(), 3U);
  EXPECT_EQ(reports_[0].code(), "deadline_exceeded");
}

}  // namespace
}  // namespace goshawk::stage
