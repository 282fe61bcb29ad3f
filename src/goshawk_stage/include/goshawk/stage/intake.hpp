#pragma once

#include <chrono>
#include <optional>
#include <utility>

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

/// Takes a request in. @return the request if it is valid and within its deadline; otherwise
/// nothing, and the failure has been reported
inline std::optional<PlanRequest> open_request(const goshawk_msgs::msg::PlanRequest& m,
                                               std::int64_t now_ns, StageReporter& reporter,
                                               Timing timing) {
  auto request = conversions::from_msg(m);
  Status status = request ? check_deadline(*request, now_ns) : request.error();
  if (status) return *std::move(request);
  reporter.failed(m.id(), status.error(), timing);
  return {};
}

}  // namespace goshawk::stage
