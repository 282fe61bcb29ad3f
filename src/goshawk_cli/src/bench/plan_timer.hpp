#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"

namespace goshawk::cli {

/// One plan, in nanoseconds.
struct PlanSample {
  struct Times {
    std::int64_t compute_ns = 0;
    std::int64_t wire_ns = 0;
  };
  std::int64_t total_ns = 0;
  std::map<std::string, Times> stages;  // and "reply", from the last stage back to the asker
};

/// The stages that answer a request, in their order.
inline constexpr const char* kPlanningStages[] = {"path_search", "corridor_builder",
                                                  "trajectory_optimizer"};

/// Asks for plans as the navigator would, one after another, and times the answers.
class PlanTimer {
 public:
  PlanTimer(runtime::Node& node, const Vec3& start_map, const Vec3& goal_map, const Limits& limits);

  bool stages_ready() const;

  /// @return the sample, or why there is none
  Result<PlanSample> once(double timeout_s);

 private:
  void on_trajectory(const goshawk_msgs::msg::BezierTrajectory& m,
                     const runtime::MessageInfo& info);
  void on_report(const goshawk_msgs::msg::StageReport& m);

  runtime::Node& node_;
  runtime::Publisher<goshawk_msgs::msg::PlanRequest> requests_;
  PlanRequest request_;
  std::set<std::string> ready_;  // roles
  PlanSample sample_;
  std::int64_t reply_wire_ns_ = 0;
  std::optional<Error> failure_;
};

}  // namespace goshawk::cli
