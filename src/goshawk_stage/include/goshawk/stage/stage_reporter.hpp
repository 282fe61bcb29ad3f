#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "goshawk/core/error.hpp"
#include "goshawk/core/stage_role.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"

namespace goshawk::stage {

struct Timing {
  std::int64_t wire_ns = 0;     // [ns] from the input's stamp to its arrival here
  std::int64_t compute_ns = 0;  // [ns] in the core
};

/// How a stage answers on `stage_report`: once when it is ready, then for every request, with a
/// result or with the reason why there is none. Silence is a fault.
class StageReporter {
 public:
  using Counters = std::initializer_list<std::pair<const char*, double>>;

  /// Also reports whom the node does not hear (runtime::Writers).
  StageReporter(runtime::Node& node, StageRole role, std::string implementation);
  StageReporter(const StageReporter&) = delete;
  StageReporter& operator=(const StageReporter&) = delete;

  void set_implementation(std::string implementation);

  /// About the stage itself, request 0.
  void ready(const std::string& message);
  void fault(const Error& error);
  /// As fault(), but once a second at most: for input that comes hundreds of times a second.
  void complain(const Error& error);

  /// About one request.
  /// @param note what the asker should know of the answer, or nothing
  void answered(std::uint64_t request_id, Timing timing, Counters counters = {},
                const std::string& note = "");
  void failed(std::uint64_t request_id, const Error& error, Timing timing = {});

  /// Publishes; reports a message that the middleware refuses.
  /// @param request_id the request that fails with it; 0: none, the stage complains
  template <typename Message>
  void send(const runtime::Publisher<Message>& publisher, const Message& message,
            std::uint64_t request_id = 0) {
    if (const Status status = publisher.publish(message); !status) {
      not_sent(request_id, status.error());
    }
  }

 private:
  void not_sent(std::uint64_t request_id, const Error& error);
  void tell_of_refusals();
  void publish(std::uint64_t request_id, ErrorCode code, const std::string& message, Timing timing,
               Counters counters);

  runtime::Node& node_;
  runtime::Publisher<goshawk_msgs::msg::StageReport> publisher_;
  goshawk_msgs::msg::StageReport report_;
  std::int64_t complained_ns_ = 0;
  std::uint64_t refused_ = 0;  // datagrams, when they were last told
};

}  // namespace goshawk::stage
