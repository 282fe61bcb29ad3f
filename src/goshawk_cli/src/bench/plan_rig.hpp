#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bench/plan_timer.hpp"
#include "flight/child_verb.hpp"
#include "goshawk/runtime/node.hpp"
#include "planning/planning.hpp"

namespace goshawk::cli {

struct PlanRigOptions {
  MapOptions map;
  Vec3 start_map = Vec3(3.0, 0.0, 1.0);  // [m]
  Vec3 goal_map = Vec3(3.0, 8.0, 2.0);   // [m]
  std::string launch = "flight";
  std::string secure;  // folder of `goshawk secure init`; empty: without DDS Security
};

/// A launched flight whose planning stages are asked for plans by this process, not by its
/// navigator.
class PlanRig {
 public:
  /// @return invalid_parameter, io_failed, or stage_silent: the stages do not become ready
  static Result<std::unique_ptr<PlanRig>> start(const PlanRigOptions& options);

  /// @return the next plan's times; or why there was none, ten times in a row
  Result<PlanSample> sample();

  /// [s] processor time of the flight's processes since they began; of those that run
  double processor_s() const;

 private:
  PlanRig() = default;
  Status join(const PlanRigOptions& options, int domain);
  Status wait_until_ready(const std::string& folder);

  std::unique_ptr<runtime::Context> context_;
  std::unique_ptr<runtime::Node> node_;
  std::unique_ptr<PlanTimer> timer_;
  std::optional<ChildVerb> launch_;
};

}  // namespace goshawk::cli
