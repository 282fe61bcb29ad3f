#include <fmt/format.h>

#include "strategies.hpp"

namespace goshawk::trajectory_optimizer {

Error no_flight(const Task& task) {
  using Status = SplineSolver::Status;
  const Effort& effort = task.effort;
  const std::string numbers =
      fmt::format(" ({} solves, {} iterations; last primal residual {:.2g}, gap {:.2g})",
                  effort.solves, effort.iterations, effort.last.primal_residual, effort.last.gap);
  if (effort.stopped()) {
    return fail(ErrorCode::deadline_exceeded,
                "the deadline passed before a trajectory was found: allow more time" + numbers);
  }
  if (!from_rest_to_rest(task.request) && effort.last.status != Status::numerical_trouble) {
    return fail(ErrorCode::start_infeasible,
                fmt::format("no trajectory from {:.3g} m/s stays in the corridor and within the "
                            "limits: replan from farther ahead, widen the corridor or raise the "
                            "acceleration limit{}",
                            task.request.start.velocity.norm(), numbers));
  }
  if (effort.last.status == Status::infeasible) {
    return fail(ErrorCode::trajectory_infeasible,
                "no trajectory stays in the corridor and within the limits: let consecutive "
                "polytopes overlap more or raise max_stretch" +
                    numbers);
  }
  return fail(ErrorCode::solver_failed,
              "the solver found no trajectory: look for very thin or very small polytopes, or "
              "raise max_iterations" +
                  numbers);
}

}  // namespace goshawk::trajectory_optimizer
