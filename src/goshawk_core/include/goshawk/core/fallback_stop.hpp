#pragma once

#include <cstddef>
#include <vector>

#include "goshawk/core/trajectory.hpp"

namespace goshawk {

/// How a vehicle comes to rest by itself if setpoints stop coming: the reference of the tracker,
/// braked on the path that was proved free. States at equal steps, joined by quintics; times count
/// from when it comes. Frame `map`.
struct FallbackStop {
  static constexpr std::size_t kMostStates = 1000;

  double step_s = 0.0;            // [s] between two states
  std::vector<FlatState> states;  // jerk is not used; the last one is at rest

  double duration_s() const { return step_s * double(states.size() - 1); }
  /// Before the first state: that state. After the last: its position, at rest. @pre check() ok
  FlatState at(double t_s) const;

  /// When it is nearest to a place, within [from_s, to_s] and its own duration.
  /// @pre check() ok; from_s <= to_s
  double nearest_time_s(const Vec3& position_map, double from_s, double to_s) const;

  /// @return invalid_input: no state or more than kMostStates, a state beyond 1e6 m, m/s or m/s^2
  ///         or not finite, a step outside of 1e-6 to 10 s, a last state that is not at rest
  Status check() const;
};

}  // namespace goshawk
