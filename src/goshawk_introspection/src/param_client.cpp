#include "goshawk/introspection/param_client.hpp"

#include <unistd.h>

#include <chrono>
#include <optional>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk_msgs.h"

namespace goshawk::introspection {
namespace {

using goshawk_msgs::msg::Parameter;
using goshawk_msgs::msg::ParameterAnswer;
using goshawk_msgs::msg::ParameterRequest;
namespace verb = goshawk_msgs::msg::ParameterRequest_Constants;

constexpr double kSurely_s = 3.0;     // six announcements of each node
constexpr double kAskAgain_s = 0.25;  // discovery is not done at one moment for both ways
const runtime::Qos kQos = runtime::Qos::reliable_last(50);

ParameterRequest to_msg(const ParameterQuestion& question, std::int64_t now_ns) {
  ParameterRequest request;
  request.header().stamp(conversions::to_stamp(now_ns));
  request.id(std::uint64_t(now_ns));
  request.client("goshawk_param_" + std::to_string(getpid()));
  request.node(question.node);
  request.verb(question.verb == ParameterVerb::get ? verb::VERB_GET : verb::VERB_SET);
  for (const auto& [name, value] : question.parameters) {
    Parameter p;
    p.name(name);
    p.value(value);
    request.parameters().push_back(std::move(p));
  }
  return request;
}

Result<std::vector<LiveParameter>> from_msg(const ParameterAnswer& answer) {
  if (answer.code() != to_string(ErrorCode::ok)) {
    // A request that is not valid is a wrong call, whichever of the two codes the node gives it.
    const bool refused = answer.code() == to_string(ErrorCode::not_permitted);
    return fail(refused ? ErrorCode::not_permitted : ErrorCode::invalid_parameter, answer.message());
  }
  std::vector<LiveParameter> list;
  for (const Parameter& p : answer.parameters()) {
    list.push_back({{p.name(), p.type(), p.unit(), p.text(), p.default_value(), p.range(),
                     p.value(), p.at_run_time()},
                    p.old_value()});
  }
  return list;
}

Error nobody_answered(const Session& session, const std::string& node) {
  const auto known = session.nodes();
  if (std::ranges::find(known, node) != known.end()) {
    return fail(ErrorCode::stage_silent,
                node +
                    " is there, but did not answer in time. It answers between two requests: is "
                    "it computing, or is it a program without parameters? What was asked may "
                    "still be done; --timeout waits longer");
  }
  return session.no_node(node);
}

/// True once others are there, and nobody new came for so long that the one asked for is not.
class Absence {
 public:
  bool is_certain(const Session& session, const std::string& node) {
    const auto known = session.nodes();
    const auto now = std::chrono::steady_clock::now();
    if (known.size() != seen_) changed_ = now;
    seen_ = known.size();
    return seen_ > 0 && std::ranges::find(known, node) == known.end() &&
           now - changed_ > std::chrono::duration<double>(kSurely_s);
  }

 private:
  std::size_t seen_ = 0;
  std::chrono::steady_clock::time_point changed_ = std::chrono::steady_clock::now();
};

}  // namespace

Result<std::vector<LiveParameter>> ask(Session& session, const ParameterQuestion& question,
                                       double timeout_s) {
  const auto request = to_msg(question, runtime::SystemClock().now_ns());
  std::optional<ParameterAnswer> answer;
  session.node().subscribe<ParameterAnswer>(
      "/parameter_answer", kQos, [&](const ParameterAnswer& m, const runtime::MessageInfo&) {
        if (m.client() == request.client() && m.id() == request.id()) answer = m;
      });
  const auto requests = session.node().advertise<ParameterRequest>("/parameter_request", kQos);
  auto asked = std::chrono::steady_clock::time_point();
  Absence absence;
  session.wait_for(timeout_s, [&] {
    const auto now = std::chrono::steady_clock::now();
    if (!answer && requests.matched() > 0 &&
        now - asked > std::chrono::duration<double>(kAskAgain_s)) {
      asked = now;
      (void)requests.publish(request);  // asked again if it is lost
    }
    return answer.has_value() || absence.is_certain(session, question.node);
  });
  if (!answer) return nobody_answered(session, question.node);
  return from_msg(*answer);
}

}  // namespace goshawk::introspection
