#include "goshawk/px4_topics/px4_topics.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>

#include "goshawk/px4_wire/messages.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "goshawk_msgs.h"

namespace goshawk::px4 {
namespace {

std::unique_ptr<runtime::Context> join() {
  static const int domain = runtime::hold_private_domain().value();
  runtime::ContextOptions options;
  options.domain = domain;
  auto context = runtime::Context::create(options);
  if (!context) throw std::runtime_error(context.error().message);
  return *std::move(context);
}

struct End {
  explicit End(const char* name) : node(*context, name), reporter(node, StageRole::vehicle, name) {}
  std::unique_ptr<runtime::Context> context = join();
  runtime::Node node;
  stage::StageReporter reporter;
};

struct Ends {
  End px4{"px4"}, ours{"bridge"};

  template <typename Done>
  bool spin_until(const Done& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (!done() && std::chrono::steady_clock::now() < end) {
      px4.node.spin_some(0.0);
      ours.node.spin_some(0.01);
    }
    return done();
  }
};

TEST(Px4Topics, AMessageComesAsItWasSent) {
  Ends ends;
  Px4Topics from(ends.px4.node, ends.px4.reporter, Release::v1_17);
  Px4Topics to(ends.ours.node, ends.ours.reporter, Release::v1_17);
  from.advertise<VehicleStatus>();
  VehicleStatus sent;
  sent.arming_state = VehicleStatus::kArmed;
  sent.system_id = 3;
  std::optional<VehicleStatus> received;
  to.subscribe<VehicleStatus>([&](const VehicleStatus& m) { received = m; },
                              runtime::Writers::any());
  ASSERT_TRUE(ends.spin_until([&] {
    from.send(sent);
    return received.has_value();
  }));
  EXPECT_EQ(*received, sent);
}

// Releases 1.17 and 1.18 have FailsafeFlags on one topic, in different layouts of another size.
TEST(Px4Topics, AnotherLayoutIsReportedNotRead) {
  Ends ends;
  Px4Topics from(ends.px4.node, ends.px4.reporter, Release::v1_17);
  Px4Topics to(ends.ours.node, ends.ours.reporter, Release::v1_18);
  from.advertise<FailsafeFlags>();
  bool heard = false;
  to.subscribe<FailsafeFlags>([&](const FailsafeFlags&) { heard = true; }, runtime::Writers::any());
  std::string said;
  ends.px4.node.subscribe<goshawk_msgs::msg::StageReport>(
      "stage_report", runtime::Qos::latched(20),
      [&](const goshawk_msgs::msg::StageReport& m, const runtime::MessageInfo&) {
        if (m.code() == "invalid_input") said = m.message();
      });
  ASSERT_TRUE(ends.spin_until([&] {
    from.send(FailsafeFlags{});
    return !said.empty();
  }));
  EXPECT_FALSE(heard);
  EXPECT_NE(said.find("px4_release"), std::string::npos) << said;
}

}  // namespace
}  // namespace goshawk::px4
