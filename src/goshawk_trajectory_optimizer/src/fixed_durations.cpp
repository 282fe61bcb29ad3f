#include <algorithm>

#include "strategies.hpp"

namespace goshawk::trajectory_optimizer {

std::optional<Flight> fixed_durations(const Task& task) {
  return stretched(task, cut_trapezoid(task.request, task.corridor, task.config));
}

std::optional<Flight> stretched(const Task& task, const Plan& plan) {
  constexpr double kFirstStep = 1e-3;
  constexpr double kMostStep = 0.2;
  double factor = 1.0;
  for (double step = kFirstStep; factor <= task.config.max_stretch;
       step = std::min(2.0 * step, kMostStep)) {
    Plan longer = plan;
    longer.stretch(factor);
    if (solve_fixed(task, longer)) {
      if (auto flight = judge(task, longer).flight) return flight;
    }
    if (task.effort.stopped()) break;
    factor *= 1.0 + step;
  }
  return {};
}

}  // namespace goshawk::trajectory_optimizer
