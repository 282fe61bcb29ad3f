#include <gmock/gmock.h>

#include <thread>

#include "domain.hpp"
#include "goshawk_msgs.h"
#include "test_config.hpp"

namespace goshawk::runtime {
namespace {

using goshawk_msgs::msg::Parameter;
using goshawk_msgs::msg::ParameterAnswer;
using goshawk_msgs::msg::ParameterRequest;
using goshawk_msgs::msg::ParameterRequest_Constants::VERB_GET;
using goshawk_msgs::msg::ParameterRequest_Constants::VERB_SET;
using runtime_test::Config;
using runtime_test::join;
using runtime_test::spin_until;
using testing::AllOf;
using testing::HasSubstr;

ParameterRequest request(std::uint64_t id, std::uint8_t verb,
                         const std::vector<std::pair<std::string, std::string>>& values = {}) {
  ParameterRequest r;
  r.id(id);
  r.client("test");
  r.node("/search");
  r.verb(verb);
  for (const auto& [name, value] : values) {
    Parameter p;
    p.name(name);
    p.value(value);
    r.parameters().push_back(p);
  }
  return r;
}

/// A node with a thread of its own in one participant, who asks in another.
class ParameterTopics : public testing::Test {
 protected:
  ParameterTopics() {
    config_ = server_.parameters<Config>([this](const Config& c) {
      config_ = c;
      ++taken_;
      return success();
    });
    client_.subscribe<ParameterAnswer>("/parameter_answer", Qos::reliable_last(100),
                                       [this](const auto& m, const auto&) {
                                         got_.push_back(m);
                                         if (m.id() == kOther) ++answers_to_others_;
                                       });
    requests_ = client_.advertise<ParameterRequest>("/parameter_request", Qos::reliable_last(100));
    server_thread_ = std::thread([this] { server_.spin(); });
  }
  ~ParameterTopics() override {
    server_.stop();
    if (server_thread_.joinable()) server_thread_.join();
  }

  ParameterAnswer ask(const ParameterRequest& r) {
    // The two ends may know of each other at different moments: asked until answered.
    for (int k = 0; k < 200 && answer_to(r.id()) == nullptr; ++k) {
      (void)requests_.publish(r);
      spin_until(
          client_, [&] { return answer_to(r.id()) != nullptr; }, 0.3);
    }
    if (answer_to(r.id()) == nullptr) throw std::runtime_error("no answer");
    const ParameterAnswer answer = *answer_to(r.id());
    got_.clear();
    return answer;
  }

  const ParameterAnswer* answer_to(std::uint64_t id) const {
    for (const auto& answer : got_) {
      if (answer.id() == id) return &answer;
    }
    return nullptr;
  }

  std::unique_ptr<Context> server_context_ = join({"/search"});
  std::unique_ptr<Context> client_context_ = join();
  Node server_{*server_context_, "search"};
  Node client_{*client_context_, "client"};
  Config config_;
  int taken_ = 0;  // of the server's thread: read once that has ended
  Publisher<ParameterRequest> requests_;
  static constexpr std::uint64_t kOther = 41;  // a request to another node
  std::vector<ParameterAnswer> got_;
  int answers_to_others_ = 0;
  std::thread server_thread_;
};

TEST_F(ParameterTopics, GetTellsEverythingOfAllOrOfSome) {
  const auto all = ask(request(1, VERB_GET));
  EXPECT_EQ(all.code(), "ok");
  EXPECT_EQ(all.node(), "/search");
  EXPECT_EQ(all.client(), "test");
  EXPECT_EQ(all.id(), 1U);
  ASSERT_EQ(all.parameters().size(), 6U);
  const Parameter speed = all.parameters()[1];
  EXPECT_EQ(speed.name(), "speed_m_s");
  EXPECT_EQ(speed.value(), "2");
  EXPECT_EQ(speed.type(), "double");
  EXPECT_EQ(speed.unit(), "m/s");
  EXPECT_EQ(speed.range(), "above 0");
  EXPECT_TRUE(speed.at_run_time());
  const auto some = ask(request(2, VERB_GET, {{"label", ""}, {"count", ""}}));
  ASSERT_EQ(some.parameters().size(), 2U);
  EXPECT_EQ(some.parameters()[1].name(), "count");
  EXPECT_THAT(ask(request(3, VERB_GET, {{"lable", ""}})).message(),
              HasSubstr("did you mean label?"));
}

TEST_F(ParameterTopics, SetTakesEffectOnceHoweverOftenItIsAsked) {
  const auto r = request(7, VERB_SET, {{"speed_m_s", "3.5"}, {"label", "x"}});
  for (int k = 0; k < 3; ++k) {
    const auto answer = ask(r);
    EXPECT_EQ(answer.code(), "ok") << answer.message();
    ASSERT_EQ(answer.parameters().size(), 2U);
    EXPECT_EQ(answer.parameters()[0].old_value(), "2");
    EXPECT_EQ(answer.parameters()[0].value(), "3.5");
  }
  EXPECT_EQ(ask(request(8, VERB_SET, {{"speed_m_s", "4"}})).parameters()[0].old_value(), "3.5");
  server_.stop();
  server_thread_.join();
  EXPECT_EQ(taken_, 2);
  EXPECT_EQ(config_.speed_m_s, 4.0);
  EXPECT_EQ(config_.label, "x");
}

TEST_F(ParameterTopics, WhatIsWrongIsASentenceAndChangesNothing) {
  std::uint64_t id = 20;
  const auto refusal = [&](const ParameterRequest& r) {
    const auto answer = ask(r);
    EXPECT_TRUE(answer.parameters().empty());
    return answer.code() + ": " + answer.message();
  };
  EXPECT_THAT(refusal(request(++id, VERB_SET, {{"speed_m_s", "3"}, {"radius_m", "1"}})),
              AllOf(HasSubstr("invalid_parameter"), HasSubstr("at start only")));
  EXPECT_THAT(refusal(request(++id, VERB_SET, {{"count", "1"}, {"count", "2"}})),
              HasSubstr("is specified twice"));
  EXPECT_THAT(refusal(request(++id, VERB_SET)),
              HasSubstr("invalid_input: the request sets nothing"));
  EXPECT_THAT(refusal(request(++id, VERB_SET, {{"", "1"}})), HasSubstr("without a name"));
  EXPECT_THAT(refusal(request(++id, VERB_SET, {{"label", std::string(5000, 'x')}})),
              HasSubstr("longer than 4096 bytes for label"));
  EXPECT_THAT(refusal(request(++id, VERB_SET, {{"label", "a\n[navigator] info: b"}})),
              HasSubstr("control character"));
  EXPECT_THAT(refusal(request(++id, 7)), HasSubstr("neither VERB_GET nor VERB_SET"));
  EXPECT_THAT(refusal(request(0, VERB_GET)), HasSubstr("has id 0"));
  std::vector<std::pair<std::string, std::string>> many(1001, {"label", "x"});
  EXPECT_THAT(refusal(request(++id, VERB_SET, many)), HasSubstr("too many"));
  auto nobody = request(++id, VERB_GET);
  nobody.client("");
  EXPECT_THAT(refusal(nobody), HasSubstr("names no client"));

  const auto all = ask(request(++id, VERB_GET));
  EXPECT_EQ(all.parameters()[1].value(), "2");
  EXPECT_EQ(all.parameters()[5].value(), "");
  server_.stop();
  server_thread_.join();
  EXPECT_EQ(taken_, 0);
}

TEST_F(ParameterTopics, ANodeAnswersOnlyForItself) {
  ask(request(40, VERB_GET));  // both ends know each other
  auto other = request(kOther, VERB_SET, {{"speed_m_s", "9"}});
  other.node("/uav1/search");
  ASSERT_TRUE(requests_.publish(other));
  EXPECT_EQ(ask(request(42, VERB_GET)).parameters()[1].value(), "2");
  // Reliable and in order: an answer to the other one would have come before.
  EXPECT_EQ(answers_to_others_, 0);
}

TEST_F(ParameterTopics, BytesThatAreNoRequestAreDropped) {
  ask(request(50, VERB_GET));
  auto bytes = encode(request(51, VERB_SET, {{"speed_m_s", "9"}}));
  const auto type = raw_message_type(message_type<ParameterRequest>().name());
  const auto attacker = client_.advertise_raw("/parameter_request", type, Qos::reliable_last(100));
  ASSERT_TRUE(spin_until(client_, [&] { return attacker.matched() > 0; }));
  for (std::size_t n = 4; n + 4 < bytes.size(); n += 5) {  // the last 3 may be padding
    const std::vector<unsigned char> cut(bytes.begin(), bytes.begin() + long(n));
    ASSERT_TRUE(attacker.publish_raw(&cut));
  }
  EXPECT_TRUE(attacker.wait_acknowledged(60.0));
  EXPECT_EQ(ask(request(52, VERB_GET)).parameters()[1].value(), "2");
}

TEST_F(ParameterTopics, ANodeThatIsFixedTellsButTakesNothing) {
  RosArgs args;
  args.overrides = {{"", "set_parameters", "none"}};
  Node fixed(*server_context_, "fixed", args);
  fixed.parameters<Config>([](const Config&) { return success(); });
  std::thread thread([&] { fixed.spin(); });
  auto get = request(60, VERB_GET);
  auto set = request(61, VERB_SET, {{"speed_m_s", "9"}});
  get.node("/fixed");
  set.node("/fixed");
  EXPECT_EQ(ask(set).code(), "not_permitted");
  const auto told = ask(get);
  EXPECT_EQ(told.code(), "ok");
  EXPECT_EQ(told.parameters()[1].value(), "2");
  fixed.stop();
  thread.join();
}

TEST_F(ParameterTopics, WhoMaySetIsOneOfThreeWords) {
  RosArgs args;
  args.overrides = {{"", "set_parameters", "somebody"}};
  Node node(*server_context_, "wrong", args);
  EXPECT_THROW(node.parameters<Config>(), StartupFault);
}

}  // namespace
}  // namespace goshawk::runtime
