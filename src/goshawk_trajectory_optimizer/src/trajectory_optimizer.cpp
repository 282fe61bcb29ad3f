#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

#include <fmt/format.h>

#include <utility>

#include "goshawk/trajectory_optimizer/request_check.hpp"
#include "strategies.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kLongest_s = 1e6;

Status check_duration(double duration_s) {
  if (duration_s >= 0.0 && duration_s <= kLongest_s) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("a duration of {} s is out of range: ask for up to 1e6 s, or for 0 to "
                          "arrive as soon as the limits allow",
                          duration_s));
}

// When to arrive; nothing: as soon as the limits allow.
std::optional<double> arrival_s(const Task& task, const Flight& soonest) {
  if (task.request.duration_s > 0.0) return task.request.duration_s;
  const double extra = task.config.extra_time;
  if (extra > 0.0) return (1.0 + extra) * soonest.trajectory.duration_s();
  return {};
}

Result<Flight> answer(const Task& task) {
  auto soonest = fastest(task);
  if (!soonest) return no_flight(task);
  auto flight = within_vehicle(task, *std::move(soonest));
  if (!flight) return flight;
  if (const auto duration_s = arrival_s(task, *flight)) {
    return arrive_after(task, *duration_s, *std::move(flight));
  }
  return flight;
}

}  // namespace

TrajectoryOptimizer::TrajectoryOptimizer(const Config& config)
    : config_(config), workspace_(std::make_unique<Workspace>()) {}
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
  if (auto status = check_duration(query.duration_s); !status) return status.error();
  const Request request{corridor, start, goal, limits, query.duration_s, &query.out_of_time};
  Effort effort;
  auto flight = answer({request, config_, *workspace_, effort});
  if (!flight) return flight.error();
  const int pieces = int(flight->trajectory.pieces.size());
  return Solution{std::move(flight->trajectory),
                  flight->certificate,
                  effort.iterations,
                  effort.solves,
                  pieces,
                  flight->jerk_cost};
}

std::string_view TrajectoryOptimizer::implementation() const {
  return config_.method == "fixed" ? "bezier-fixed" : "bezier-scale";
}

}  // namespace goshawk::trajectory_optimizer
