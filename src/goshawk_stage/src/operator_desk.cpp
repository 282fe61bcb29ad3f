#include "goshawk/stage/operator_desk.hpp"

#include <algorithm>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::stage {
namespace {

constexpr std::size_t kMostAnswers = 16;     // kept for clients that ask again
constexpr std::size_t kLongestClient = 256;  // [byte]

Status check_sender(std::uint64_t id, const std::string& client) {
  if (id == 0) return fail(ErrorCode::invalid_input, "the command has id 0: count from 1");
  // It is logged, and must not look like another line of the log.
  const bool printable =
      std::ranges::none_of(client, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (!client.empty() && client.size() <= kLongestClient && printable) return success();
  return fail(ErrorCode::invalid_input, "the command names no client");
}

}  // namespace

OperatorDesk::OperatorDesk(runtime::Node& node, StageReporter& reporter)
    : node_(node),
      reporter_(reporter),
      publisher_(node.advertise<Answer>("operator_answer", runtime::Qos::reliable_last())) {}

void OperatorDesk::answer(std::uint64_t id, const std::string& client, const CarryOut& carry_out) {
  const auto before = std::ranges::find_if(
      given_, [&](const Answer& a) { return a.id() == id && a.client() == client; });
  if (before != given_.end()) return reporter_.send(publisher_, *before);
  const Status sender = check_sender(id, client);
  const auto done = sender ? carry_out() : Result<std::string>(sender.error());
  Answer answer;
  answer.header(conversions::make_header(node_.now_ns()));
  answer.id(id);
  if (sender) answer.client(client);
  answer.node(node_.full_name());
  answer.code(std::string(to_string(done.code())));
  answer.message(done ? *done : done.error().message);
  reporter_.send(publisher_, answer);
  if (!sender) return;
  given_.push_back(std::move(answer));
  if (given_.size() > kMostAnswers) given_.pop_front();
}

}  // namespace goshawk::stage
