#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "goshawk/stage/stage_reporter.hpp"

namespace goshawk::stage {

/// Answers people on `operator_answer`: each command is carried out once, and answered again if it
/// is repeated, so that a client repeats it until it hears the answer.
///
///     OperatorDesk desk(node, reporter);
///     desk.answer(m.id(), m.client(), [&] { return hold(); });
class OperatorDesk {
 public:
  /// @return what happens now, in a sentence, or why nothing does
  using CarryOut = std::function<Result<std::string>()>;

  OperatorDesk(runtime::Node& node, StageReporter& reporter);
  OperatorDesk(const OperatorDesk&) = delete;
  OperatorDesk& operator=(const OperatorDesk&) = delete;

  /// @param id, client of the command; a command with id 0, or with a client that is no name of at
  ///   most 256 printable bytes, is refused and not carried out
  void answer(std::uint64_t id, const std::string& client, const CarryOut& carry_out);

 private:
  using Answer = goshawk_msgs::msg::OperatorAnswer;

  runtime::Node& node_;
  StageReporter& reporter_;
  runtime::Publisher<Answer> publisher_;
  std::deque<Answer> given_;  // the newest
};

}  // namespace goshawk::stage
