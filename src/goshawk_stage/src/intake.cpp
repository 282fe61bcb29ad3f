#include "goshawk/stage/intake.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace goshawk::stage {
namespace {

constexpr std::size_t kMostKept = 64;  // more than a stage's queue can hold

}  // namespace

void SupersededRequests::note(std::uint64_t id, std::uint64_t supersedes) {
  if (supersedes == 0 || supersedes == id || !check(supersedes)) return;
  pairs_.emplace_back(supersedes, id);
  if (pairs_.size() > kMostKept) pairs_.pop_front();
}

Status SupersededRequests::check(std::uint64_t id) const {
  const auto at = std::ranges::find(pairs_, id, &std::pair<std::uint64_t, std::uint64_t>::first);
  if (at == pairs_.end()) return success();
  return fail(ErrorCode::cancelled,
              fmt::format("request {} was dropped: request {} supersedes it", id, at->second));
}

std::int64_t RequestArrivals::note(const goshawk_msgs::msg::PlanRequest& m,
                                   std::int64_t arrived_ns) {
  const std::int64_t stamp_ns = conversions::to_ns(m.header().stamp());
  const auto known = std::ranges::find_if(
      arrivals_, [&](const Arrival& a) { return a.id == m.id() && a.stamp_ns == stamp_ns; });
  if (known != arrivals_.end()) return known->arrived_ns;
  arrivals_.push_back({m.id(), stamp_ns, arrived_ns});
  if (arrivals_.size() > kMostKept) arrivals_.pop_front();
  return arrived_ns;
}

std::optional<PlanRequest> open_request(const goshawk_msgs::msg::PlanRequest& m,
                                        std::int64_t arrived_ns, std::int64_t now_ns,
                                        StageReporter& reporter, Timing timing,
                                        const SupersededRequests& superseded) {
  auto request = conversions::from_msg(m);
  if (request) request->stamp_ns = arrived_ns;
  Status status = request ? check_deadline(*request, now_ns) : request.error();
  if (status) status = superseded.check(m.id());
  if (status) return *std::move(request);
  reporter.failed(m.id(), status.error(), timing);
  return {};
}

}  // namespace goshawk::stage
