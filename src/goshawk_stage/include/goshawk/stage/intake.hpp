#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/stage/stage_reporter.hpp"

namespace goshawk::stage {

/// Runs `work` and measures it. @return {result, time [ns]}
template <typename Work>
auto timed(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = std::forward<Work>(work)();
  const auto end = std::chrono::steady_clock::now();
  return std::pair{std::move(result), std::int64_t{(end - begin).count()}};
}

/// @return [ns] how long a message travelled: from its stamp to its arrival, same clock
inline std::int64_t wire_time_ns(const std_msgs::msg::Header& header,
                                 const runtime::MessageInfo& info) {
  return info.received_ns - conversions::to_ns(header.stamp());
}

/// Remembers which requests newer ones have made obsolete.
class SupersededRequests {
 public:
  /// @param id the newer request @param supersedes the request that it replaces; 0: none
  void note(std::uint64_t id, std::uint64_t supersedes);

  /// @return cancelled, with the newer request in its sentence, for an obsolete request
  Status check(std::uint64_t id) const;

 private:
  std::deque<std::pair<std::uint64_t, std::uint64_t>> pairs_;  // obsolete, newer; the newest ones
};

/// Takes a request in. @return the request if it is valid, within its deadline and not superseded;
/// otherwise nothing, and the failure has been reported
std::optional<PlanRequest> open_request(const goshawk_msgs::msg::PlanRequest& m,
                                        std::int64_t now_ns, StageReporter& reporter, Timing timing,
                                        const SupersededRequests& superseded = {});

/// The input of a planning stage: requests on one topic, alone or inside another message. It hears
/// of every newer request before it hands out an older one, so that obsolete work is dropped.
///
///     Intake<msg::Path> paths(node, reporter, "path",
///         [this](const msg::Path& m, const PlanRequest& request, Timing timing)
///         {...});
template <typename Message>
class Intake {
 public:
  using Handler = std::function<void(const Message&, const PlanRequest&, Timing timing)>;

  /// @param handler called in the node's thread with each request that is worth an answer
  Intake(runtime::Node& node, StageReporter& reporter, std::string_view topic, Handler handler)
      : node_(node), reporter_(reporter), handler_(std::move(handler)) {
    if constexpr (!kIsRequest) {
      node.subscribe<Request>(
          "plan_request", runtime::Qos::reliable_last(),
          [this](const Request& m, const auto&) { note(m); },
          runtime::Writers::one("plan_request"));
    }
    node.subscribe<Message>(
        topic, runtime::Qos::reliable_last(),
        [this](const Message& m, const runtime::MessageInfo& info) {
          note(request_of(m));
          waiting_.emplace_back(m, wire_time_ns(m.header(), info));
          if (waiting_.size() == 1) node_.later([this] { serve(); });
        },
        runtime::Writers::one(std::string(topic)));
  }
  Intake(const Intake&) = delete;
  Intake& operator=(const Intake&) = delete;

 private:
  using Request = goshawk_msgs::msg::PlanRequest;
  static constexpr bool kIsRequest = std::is_same_v<Message, Request>;

  static const Request& request_of(const Message& m) {
    if constexpr (kIsRequest) {
      return m;
    } else {
      return m.request();
    }
  }

  void note(const Request& request) { superseded_.note(request.id(), request.supersedes()); }

  void serve() {
    for (const auto& [message, wire_ns] : std::exchange(waiting_, {})) {
      const Timing timing{.wire_ns = wire_ns};
      const auto request =
          open_request(request_of(message), node_.now_ns(), reporter_, timing, superseded_);
      if (request) handler_(message, *request, timing);
    }
  }

  runtime::Node& node_;
  StageReporter& reporter_;
  Handler handler_;
  SupersededRequests superseded_;
  std::vector<std::pair<Message, std::int64_t>> waiting_;  // with the time on the wire [ns]
};

}  // namespace goshawk::stage
