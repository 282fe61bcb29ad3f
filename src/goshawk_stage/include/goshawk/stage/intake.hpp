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

/// Remembers when each request was first heard of. Deadlines count from then, on the stage's own
/// clock: the asker may be another host, whose clock differs.
class RequestArrivals {
 public:
  /// @param arrived_ns [ns] monotonic, of a message with this request
  /// @return [ns] when the first one arrived
  std::int64_t note(const goshawk_msgs::msg::PlanRequest& m, std::int64_t arrived_ns);

 private:
  struct Arrival {
    std::uint64_t id;
    std::int64_t stamp_ns;  // askers may use the same ids
    std::int64_t arrived_ns;
  };
  std::deque<Arrival> arrivals_;  // the newest ones
};

/// Takes a request in. Its stamp becomes arrived_ns.
/// @param arrived_ns, now_ns [ns] monotonic: when it was first heard of, and now
/// @return the request if it is valid, within its deadline and not superseded; otherwise nothing,
/// and the failure has been reported
std::optional<PlanRequest> open_request(const goshawk_msgs::msg::PlanRequest& m,
                                        std::int64_t arrived_ns, std::int64_t now_ns,
                                        StageReporter& reporter, Timing timing,
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
          [this](const Request& m, const auto& info) { note(m, info); },
          runtime::Writers::one("plan_request"));
    }
    node.subscribe<Message>(
        topic, runtime::Qos::reliable_last(),
        [this](const Message& m, const runtime::MessageInfo& info) {
          waiting_.push_back({m, wire_time_ns(m.header(), info), note(request_of(m), info)});
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

  struct Waiting {
    Message message;
    std::int64_t wire_ns;
    std::int64_t arrived_ns;
  };

  /// @return [ns] when the request was first heard of
  std::int64_t note(const Request& request, const runtime::MessageInfo& info) {
    superseded_.note(request.id(), request.supersedes());
    return arrivals_.note(request, node_.monotonic_ns() - info.waited_ns);
  }

  void serve() {
    for (const auto& [message, wire_ns, arrived_ns] : std::exchange(waiting_, {})) {
      const Timing timing{.wire_ns = wire_ns};
      const auto request = open_request(request_of(message), arrived_ns, node_.monotonic_ns(),
                                        reporter_, timing, superseded_);
      if (request) handler_(message, *request, timing);
    }
  }

  runtime::Node& node_;
  StageReporter& reporter_;
  Handler handler_;
  SupersededRequests superseded_;
  RequestArrivals arrivals_;
  std::vector<Waiting> waiting_;
};

}  // namespace goshawk::stage
