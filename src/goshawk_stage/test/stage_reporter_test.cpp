#include "goshawk/stage/stage_reporter.hpp"

#include <gmock/gmock.h>

#include <chrono>

#include "goshawk/runtime/private_domain.hpp"

namespace goshawk::stage {
namespace {

using goshawk_msgs::msg::StageReport;
using runtime::Context;
using runtime::MessageInfo;
using runtime::Node;
using runtime::Qos;
using testing::ElementsAre;
using testing::IsEmpty;

std::unique_ptr<Context> join() {
  static const int domain = runtime::hold_private_domain();
  runtime::ContextOptions options;
  options.domain = domain;
  auto context = Context::create(options);
  if (!context) throw std::runtime_error(context.error().message);
  return *std::move(context);
}

/// A reporter whose time stands still, and a listener in a participant of its own.
class Reports : public testing::Test {
 protected:
  Reports() {
    listener_.subscribe<StageReport>(
        "stage_report", Qos::latched(20),
        [this](const StageReport& m, const MessageInfo&) { reports_.push_back(m); });
    clock_->set(1'000'000'000);
  }

  /// @return messages of all reports, once `many` have come (or a minute passed)
  std::vector<std::string> messages(std::size_t many) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (reports_.size() < many && std::chrono::steady_clock::now() < end) {
      listener_.spin_some(0.02);
    }
    std::vector<std::string> said;
    for (const auto& report : reports_) said.push_back(report.message());
    return said;
  }

  std::shared_ptr<runtime::ManualClock> clock_ = std::make_shared<runtime::ManualClock>();
  std::unique_ptr<Context> speaking_ = join();
  std::unique_ptr<Context> listening_ = join();
  Node node_{*speaking_, "stage", {}, clock_};
  Node listener_{*listening_, "listener"};
  std::vector<StageReport> reports_;
  StageReporter reporter_{node_, "method"};
};

TEST_F(Reports, SayWhoWhatAndHowLong) {
  reporter_.answered(7, {.wire_ns = 20, .compute_ns = 30}, {{"expanded", 5.0}}, "goal moved");
  ASSERT_THAT(messages(1), ElementsAre("goal moved"));
  const StageReport& report = reports_[0];
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
  clock_->set(1'999'999'999);
  complain("too soon");
  reporter_.fault(fail(ErrorCode::invalid_input, "fault"));
  clock_->set(2'000'000'000);
  complain("a second later");
  clock_->set(500'000'000);  // simulated time began anew
  complain("in a new simulation");
  EXPECT_THAT(messages(4), ElementsAre("first", "fault", "a second later", "in a new simulation"));
}

TEST_F(Reports, OfARequestNameIt) {
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
