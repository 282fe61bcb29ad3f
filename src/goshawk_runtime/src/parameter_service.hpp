#pragma once

#include <deque>
#include <memory>

#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"

namespace goshawk::runtime {

/// A node's end of /parameter_request and /parameter_answer
/// (docs/adr/0008-parameters-at-run-time.md). Works in the node's thread, between two callbacks.
class ParameterService {
 public:
  using MaySet = std::function<Status(const Participant& asker)>;

  /// @param may_set asked before a set: not_permitted, with the reason
  ParameterService(Node& node, std::unique_ptr<LiveParameters> parameters, MaySet may_set);
  void replace(std::unique_ptr<LiveParameters> parameters) { parameters_ = std::move(parameters); }

 private:
  using Request = goshawk_msgs::msg::ParameterRequest;
  using Answer = goshawk_msgs::msg::ParameterAnswer;
  using Listed = std::vector<goshawk_msgs::msg::Parameter>;

  void on_request(const Request& request, const Participant& asker);
  Result<Listed> answer(const Request& request, const Participant& asker);
  Result<Listed> get(const Request& request) const;
  Result<Listed> set(const Request& request);
  void log_changes(const Request& request, const Listed& changes) const;
  const Answer* given_before(const Request& request) const;
  void publish(const Answer& answer);

  Node& node_;
  std::unique_ptr<LiveParameters> parameters_;
  MaySet may_set_;
  Publisher<Answer> answers_;
  std::deque<Answer> given_;  // the newest ones, for clients that ask again
};

/// @return not_permitted unless the process may set parameters here
Status check_setter(Context::Impl& context, const Participant& asker, ParameterSetters setters);

}  // namespace goshawk::runtime
