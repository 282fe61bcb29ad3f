#include "goshawk/stage/stage_reporter.hpp"

#include <gmock/gmock.h>

#include "two_nodes.hpp"

namespace goshawk::stage {
namespace {

using goshawk_msgs::msg::StageReport;
using testing::ElementsAre;
using testing::IsEmpty;

class Reports : public testing::Test {
 protected:
  Reports() {
    nodes_.other.subscribe<StageReport>(
        "stage_report", runtime::Qos::latched(20),
        [this](const StageReport& m, const auto&) { reports_.push_back(m); });
    nodes_.clock->set(1'000'000'000);
  }

  /// @return messages of all reports, once `many` have come
  std::vector<std::string> messages(std::size_t many) {
    nodes_.spin_until([&] { return reports_.size() >= many; });
    std::vector<std::string> texts;
    for (const auto& report : reports_) texts.push_back(report.message());
    return texts;
  }

  stage_test::TwoNodes nodes_;
  std::vector<StageReport> reports_;
  StageReporter reporter_{nodes_.stage, StageRole::tracker, "method"};
};

TEST_F(Reports, NameTheRoleAndTheNode) {
  reporter_.answered(7, {.wire_ns = 20, .compute_ns = 30}, {{"expanded", 5.0}}, "goal moved");
  ASSERT_THAT(messages(1), ElementsAre("goal moved"));
  const StageReport& report = reports_[0];
  EXPECT_EQ(report.stage(), goshawk_msgs::msg::StageReport_Constants::STAGE_TRACKER);
  EXPECT_EQ(report.node(), "/renamed");
  EXPECT_EQ(report.implementation(), "method");
  EXPECT_EQ(report.request_id(), 7U);
  EXPECT_EQ(report.code(), "ok");
  EXPECT_EQ(report.header().stamp().sec(), 1);
  EXPECT_EQ(report.wire_ns(), 20);
  EXPECT_EQ(report.compute_ns(), 30);
  ASSERT_EQ(report.counters().size(), 1U);
  EXPECT_EQ(report.counters()[0].name(), "expanded");
  EXPECT_EQ(report.counters()[0].value(), 5.0);
}

TEST_F(Reports, ComplainOnceASecondButTellEveryFault) {
  const auto complain = [&](const char* text) {
    reporter_.complain(fail(ErrorCode::invalid_input, text));
  };
  complain("first");
  nodes_.clock->set(1'999'999'999);
  complain("too soon");
  reporter_.fault(fail(ErrorCode::invalid_input, "fault"));
  nodes_.clock->set(2'000'000'000);
  complain("a second later");
  nodes_.clock->set(500'000'000);  // simulated time began anew
  complain("in a new simulation");
  EXPECT_THAT(messages(4), ElementsAre("first", "fault", "a second later", "in a new simulation"));
}

TEST_F(Reports, OfARequestCarryItsIdAndCode) {
  reporter_.failed(9, fail(ErrorCode::no_path, "blocked"));
  reporter_.ready("waits");
  ASSERT_THAT(messages(2), ElementsAre("blocked", "ready: waits"));
  EXPECT_EQ(reports_[0].request_id(), 9U);
  EXPECT_EQ(reports_[0].code(), "no_path");
  EXPECT_EQ(reports_[1].request_id(), 0U);
  EXPECT_THAT(reports_[1].counters(), IsEmpty());
}

}  // namespace
}  // namespace goshawk::stage
