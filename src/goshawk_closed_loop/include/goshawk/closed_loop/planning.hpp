#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/plan_request.hpp"
#include "goshawk/core/stage_role.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/navigator/answer_check.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::closed_loop {

/// Does some work, and says how long it took [s]. Time is an argument: a flight that is to replay
/// bit for bit takes one that always says the same.
using Stopwatch = std::function<double(const std::function<void()>& work)>;

/// By the processor time of the thread that calls: what other programs take is left out.
double processor_time_s(const std::function<void()>& work);

/// The three planning stages, one after the other.
class Planning {
 public:
  struct Config {
    path_search::Config search;
    corridor_builder::Config corridor;
    trajectory_optimizer::Config optimizer;
  };
  /// [s] as a stopwatch says
  struct Times {
    double search_s = 0.0, corridor_s = 0.0, optimizer_s = 0.0;
    double all_s() const { return search_s + corridor_s + optimizer_s; }
  };
  struct Answer {
    Result<Commitment> commitment;
    StageRole last;  // the stage that made it, or failed
    navigator::Shortfall shortfall = {};
    Times times = {};
  };

  /// @return invalid_parameter with the faults of the first stage that has any
  static Result<Planning> create(const Config& config);

  /// @pre grid->check() ok
  void set_map(std::shared_ptr<const VoxelGrid> map);
  Answer plan(const PlanRequest& request, const Stopwatch& stopwatch);
  path_search::PathSearch& search() { return search_; }

 private:
  Planning(path_search::PathSearch search, corridor_builder::CorridorBuilder builder,
           trajectory_optimizer::TrajectoryOptimizer optimizer, double horizon_m)
      : horizon_m_(horizon_m),
        search_(std::move(search)),
        builder_(std::move(builder)),
        optimizer_(std::move(optimizer)) {}

  std::shared_ptr<const VoxelGrid> map_;
  double horizon_m_;
  path_search::PathSearch search_;
  corridor_builder::CorridorBuilder builder_;
  trajectory_optimizer::TrajectoryOptimizer optimizer_;
};

}  // namespace goshawk::closed_loop
