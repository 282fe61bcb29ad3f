#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

#include <utility>

#include "goshawk/trajectory_optimizer/request_check.hpp"
#include "method.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kLongest_s = 1e6;

}  // namespace

TrajectoryOptimizer::TrajectoryOptimizer(const Config& config)
    : method_(std::make_unique<Method>(config)) {}
TrajectoryOptimizer::TrajectoryOptimizer(TrajectoryOptimizer&&) noexcept = default;
TrajectoryOptimizer& TrajectoryOptimizer::operator=(TrajectoryOptimizer&&) noexcept = default;
TrajectoryOptimizer::~TrajectoryOptimizer() = default;

Result<TrajectoryOptimizer> TrajectoryOptimizer::create(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (auto status = faults.status("the optimizer's config: "); !status) return status.error();
  return TrajectoryOptimizer(config);
}

Status TrajectoryOptimizer::reconfigure(const Config& config) {
  auto other = create(config);
  if (!other) return other.error();
  *this = *std::move(other);
  return success();
}

Result<Solution> TrajectoryOptimizer::optimise(const Corridor& corridor, const FlatState& start,
                                               const FlatState& goal, const Limits& limits,
                                               const Query& query) {
  if (auto status = check_request(corridor, start, goal, limits); !status) return status.error();
  if (!(query.duration_s >= 0.0 && query.duration_s <= kLongest_s)) {
    return fail(ErrorCode::invalid_input, "a duration of " + std::to_string(query.duration_s) +
                                              " s was asked for: 0 (soon) or up to 1e6 s is meant");
  }
  return method_->answer({corridor, start, goal, limits, query.duration_s, &query.out_of_time});
}

Result<Solution> TrajectoryOptimizer::stop(const Polytope& free_space, const FlatState& start,
                                           const Limits& limits) {
  return method_->stop(free_space, start, limits);
}

std::string_view TrajectoryOptimizer::implementation() const {
  const std::string& method = method_->config().method;
  if (method == "thesis") return "bezier-thesis";
  if (method == "minimum_snap") return "polynomial-minimum-snap";
  if (method == "polynomial") return "polynomial-rechecked";
  return method == "fixed" ? "bezier-fixed" : "bezier-scale";
}

}  // namespace goshawk::trajectory_optimizer
