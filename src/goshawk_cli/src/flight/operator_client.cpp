#include "flight/operator_client.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "flight/pilot.hpp"
#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/mission_messages/messages.hpp"

namespace goshawk::cli {
namespace {

namespace msg = goshawk_msgs::msg;
namespace verb_of = goshawk_msgs::msg::OperatorCommand_Constants;
using introspection::Interruptible;

constexpr double kAskAgain_s = 0.5;

}  // namespace

OperatorClient::OperatorClient(introspection::Session& session, const std::string& space)
    : session_(session),
      space_(space),
      client_(fmt::format("goshawk/{}", ::getpid())),
      commands_(session.node().advertise<msg::OperatorCommand>(topic_in(space, "operator_command"),
                                                               runtime::Qos::reliable_last())),
      missions_(session.node().advertise<msg::Mission>(topic_in(space, "mission"),
                                                       runtime::Qos::reliable_last())) {
  session.node().subscribe<msg::OperatorAnswer>(topic_in(space, "operator_answer"),
                                                runtime::Qos::reliable_last(),
                                                [this](const msg::OperatorAnswer& m, const auto&) {
                                                  if (m.client() == client_) answer_ = m;
                                                });
}

Result<std::string> OperatorClient::command(std::uint8_t verb, double height_m, double timeout_s) {
  msg::OperatorCommand m;
  m.header(conversions::make_header(session_.node().now_ns()));
  m.id(std::uint64_t(session_.node().now_ns()));
  m.client(client_);
  m.verb(verb);
  m.height(height_m);
  const bool to_mission =
      verb == verb_of::VERB_RESUME_MISSION || verb == verb_of::VERB_CANCEL_MISSION;
  return ask(
      {m.id(), topic_in(space_, "operator_command"), to_mission},
      [&] { return commands_.publish(m); }, timeout_s);
}

Result<std::uint64_t> OperatorClient::fly(mission::Mission mission, double timeout_s) {
  mission.id = std::uint64_t(session_.node().now_ns());
  mission.client = client_;
  const auto m = mission::to_msg(mission, session_.node().now_ns());
  const auto answer = ask(
      {mission.id, topic_in(space_, "mission"), true}, [&] { return missions_.publish(m); },
      timeout_s);
  if (!answer) return answer.error();
  return mission.id;
}

Result<std::string> OperatorClient::ask(const Question& question,
                                        const std::function<Status()>& send, double timeout_s) {
  const auto is_answered = [&] { return answer_ && answer_->id() == question.id; };
  const auto begin = std::chrono::steady_clock::now();
  const auto left_s = [&] {
    return timeout_s -
           std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  while (!is_answered() && left_s() > 0.0 && !Interruptible::interrupted()) {
    if (auto status = send(); !status) return status.error();
    session_.wait_for(std::min(kAskAgain_s, std::max(left_s(), 0.01)), is_answered);
  }
  if (is_answered()) {
    if (answer_->code() == "ok") return answer_->message();
    return fail(conversions::error_code_of(answer_->code()), answer_->message());
  }
  if (Interruptible::interrupted()) return fail(ErrorCode::cancelled, "interrupted");
  return silence(question, timeout_s);
}

Error OperatorClient::silence(const Question& question, double waited_s) const {
  if (question.to_mission) {
    return fail(ErrorCode::stage_silent,
                fmt::format("no stage that flies missions answers on {} in domain {} (waited {:g} "
                            "s): start one with goshawk launch flight_mission, or with goshawk run "
                            "mission beside a flight, with the same ROS_DOMAIN_ID and namespace",
                            question.topic, session_.context().domain(), waited_s));
  }
  if (commands_.matched() == 0 || has_guard(session_, space_)) {
    return no_taker(session_, space_, question.topic, waited_s);
  }
  return fail(
      ErrorCode::stage_silent,
      fmt::format("{} is read in domain {}, but nobody has answered for {:g} s: look at the "
                  "navigator's log",
                  question.topic, session_.context().domain(), waited_s));
}

}  // namespace goshawk::cli
