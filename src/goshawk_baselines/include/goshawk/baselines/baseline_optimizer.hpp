#pragma once

#include "goshawk/baselines/config.hpp"
#include "goshawk/trajectory_optimizer/task.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::baselines {

/// The thesis' planner and the two that it compares itself with (its Table 3), as far as a
/// trajectory stage goes. They take the place of TrajectoryOptimizer: what leaves the corridor or
/// breaks a limit is refused.
class BaselineOptimizer {
 public:
  /// @return invalid_parameter
  static Result<BaselineOptimizer> create(const Config& config);
  /// From the next request on by this config; if create() would refuse it, as before.
  Status reconfigure(const Config& config);

  /// @param request a duration is refused: baselines fly as soon as they can; yaw is left alone
  /// @return as TrajectoryOptimizer::optimise(), and not_certified
  Result<trajectory_optimizer::Solution> optimise(const PlanRequest& request,
                                                  const Corridor& corridor,
                                                  const std::function<bool()>& out_of_time = {});

  /// For reports: "bezier-thesis", "polynomial-minimum-snap" or "polynomial-minimum-jerk".
  std::string_view implementation() const;

 private:
  explicit BaselineOptimizer(Config config) : config_(std::move(config)) {}
  Result<Trajectory> plan(const trajectory_optimizer::Task& task);

  Config config_;
  trajectory_optimizer::Workspace workspace_;
};

}  // namespace goshawk::baselines
