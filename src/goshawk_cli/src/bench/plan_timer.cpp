#include "bench/plan_timer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "goshawk/conversions/status.hpp"

namespace goshawk::cli {
namespace {

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;

}  // namespace

PlanTimer::PlanTimer(Node& node, const Vec3& start_map, const Vec3& goal_map, const Limits& limits)
    : node_(node),
      requests_(node.advertise<msg::PlanRequest>("plan_request", Qos::reliable_last())) {
  request_.start.position = start_map;
  request_.goal.position = goal_map;
  request_.limits = limits;
  request_.id = 1;
  node.subscribe<msg::BezierTrajectory>(
      "trajectory", Qos::reliable_last(),
      [this](const msg::BezierTrajectory& m, const MessageInfo& info) { on_trajectory(m, info); });
  node.subscribe<msg::StageReport>(
      "stage_report", Qos::latched(100),
      [this](const msg::StageReport& m, const MessageInfo&) { on_report(m); });
}

bool PlanTimer::stages_ready() const {
  return std::ranges::all_of(kPlanningStages, [&](const char* s) { return ready_.contains(s); });
}

Result<PlanSample> PlanTimer::once(double timeout_s) {
  sample_ = {};
  failure_.reset();
  ++request_.id;
  request_.stamp_ns = node_.now_ns();
  if (auto s = requests_.publish(conversions::to_msg(request_)); !s) return s.error();
  const std::int64_t end_ns = request_.stamp_ns + std::int64_t(timeout_s * 1e9);
  while (node_.now_ns() < end_ns && !failure_ &&
         (sample_.total_ns == 0 || sample_.stages.size() < std::size(kPlanningStages))) {
    node_.spin_some(0.05);
  }
  if (failure_) return *failure_;
  if (sample_.total_ns == 0) {
    return fail(ErrorCode::stage_silent,
                fmt::format("no trajectory came within {:g} s", timeout_s));
  }
  sample_.stages["reply"] = {0, reply_wire_ns_};
  return sample_;
}

void PlanTimer::on_trajectory(const msg::BezierTrajectory& m, const MessageInfo& info) {
  if (m.request().id() != request_.id) return;
  if (!conversions::from_msg(m)) return;
  sample_.total_ns = info.received_ns - request_.stamp_ns;
  reply_wire_ns_ = info.received_ns - conversions::to_ns(m.header().stamp());
}

void PlanTimer::on_report(const msg::StageReport& m) {
  const std::string stage(to_string(conversions::stage_role_of(m.stage())));
  if (m.request_id() == 0 && m.code() == "ok") ready_.insert(stage);
  if (m.request_id() != request_.id) return;
  if (m.code() == "ok") {
    sample_.stages[stage] = {m.compute_ns(), m.wire_ns()};
  } else {
    failure_ =
        fail(ErrorCode::invalid_input, fmt::format("{}: {}: {}", stage, m.code(), m.message()));
  }
}

}  // namespace goshawk::cli
