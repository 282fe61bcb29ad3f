#include "goshawk/navigator/remedy.hpp"

namespace goshawk::navigator {

Remedy remedy_of(ErrorCode code, bool from_motion) {
  using enum ErrorCode;
  switch (code) {
    case no_map:
    case deadline_exceeded:
    case stage_silent:
    case cancelled:  // by a request that is not ours: ours is dropped only for a newer one
    case trajectory_blocked:
    case not_certified:
      return Remedy::wait;
    // A vehicle that hovers moves a little: the next start may do.
    case start_outside:
    case start_occupied:
    case start_unknown:
    case start_infeasible:
    case segment_blocked:
    case corridor_disjoint:
      return from_motion ? Remedy::other_start : Remedy::wait;
    case trajectory_infeasible:
    case solver_failed:
      return from_motion ? Remedy::other_start : Remedy::other_map;
    case goal_outside:
    case goal_occupied:
    case goal_unknown:
    case no_path:
      return Remedy::other_map;
    default:
      return Remedy::none;
  }
}

bool depends_on_map(ErrorCode code) {
  using enum ErrorCode;
  switch (code) {
    case start_occupied:
    case start_unknown:
    case segment_blocked:
    case corridor_disjoint:
    case trajectory_blocked:
      return true;
    default:
      return false;
  }
}

}  // namespace goshawk::navigator
