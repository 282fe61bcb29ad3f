#include "goshawk/stage/operator_desk.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "two_nodes.hpp"

namespace goshawk::stage {
namespace {

using goshawk_msgs::msg::OperatorAnswer;

class Desk : public testing::Test {
 protected:
  Desk() {
    nodes_.other.subscribe<OperatorAnswer>(
        "operator_answer", runtime::Qos::reliable_last(50),
        [this](const OperatorAnswer& m, const auto&) { answers_.push_back(m); });
  }

  /// Asks until an answer comes, as a client does: the first ones may come before it is found.
  OperatorAnswer ask(std::uint64_t id, const std::string& client, const std::string& named) {
    answers_.clear();
    const auto is_it = [&](const OperatorAnswer& a) { return a.id() == id && a.client() == named; };
    nodes_.spin_until([&] {
      desk_.answer(id, client, [this] { return carry_out(); });
      return std::ranges::any_of(answers_, is_it);
    });
    const auto found = std::ranges::find_if(answers_, is_it);
    if (found == answers_.end()) throw std::runtime_error("no answer came");
    return *found;
  }
  OperatorAnswer ask(std::uint64_t id, const std::string& client) {
    return ask(id, client, client);
  }

  Result<std::string> carry_out() {
    ++carried_out_;
    if (carried_out_ == 3) return fail(ErrorCode::not_permitted, "not the third time");
    return std::string("done");
  }

  stage_test::TwoNodes nodes_;
  std::vector<OperatorAnswer> answers_;
  int carried_out_ = 0;
  StageReporter reporter_{nodes_.stage, StageRole::navigator, "test"};
  OperatorDesk desk_{nodes_.stage, reporter_};
};

TEST_F(Desk, CarriesACommandOutOnceAndAnswersItAgain) {
  for (int i = 0; i < 3; ++i) {
    const OperatorAnswer answer = ask(5, "me");
    EXPECT_EQ(answer.code(), "ok");
    EXPECT_EQ(answer.message(), "done");
    EXPECT_EQ(answer.node(), "/renamed");
    EXPECT_EQ(answer.id(), 5U);
    EXPECT_EQ(answer.client(), "me");
  }
  EXPECT_EQ(carried_out_, 1);
  ask(5, "another");
  EXPECT_EQ(carried_out_, 2);
  const OperatorAnswer refused = ask(6, "me");
  EXPECT_EQ(refused.code(), "not_permitted");
  EXPECT_EQ(refused.message(), "not the third time");
}

TEST_F(Desk, DoesNothingForNobody) {
  EXPECT_EQ(ask(0, "me", "").code(), "invalid_input");
  for (const std::string& client : {std::string(), std::string("a\nb"), std::string(257, 'x')}) {
    EXPECT_EQ(ask(1, client, "").code(), "invalid_input");
  }
  EXPECT_EQ(carried_out_, 0);
}

}  // namespace
}  // namespace goshawk::stage
