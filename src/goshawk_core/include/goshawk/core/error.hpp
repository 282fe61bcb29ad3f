#pragma once

#include <span>
#include <string>
#include <string_view>

namespace goshawk {

/// Why an answer is not there. The names (to_string) are a stable interface: they stand in
/// StageReport messages, in `--json` output and in docs/troubleshooting.md.
enum class ErrorCode {
  ok,
  invalid_input,      // not finite, wrong size, or not to be understood
  invalid_parameter,  // a parameter that is unknown, of the wrong type or out of range
  invalid_limits,     // a velocity or acceleration limit that is zero, negative or not finite
  wrong_frame,        // a message in a frame that this stage does not work in
  map_unreadable,     // the file is missing, cannot be opened, or has an unknown ending
  map_malformed,      // the file is truncated or is not what its ending says
  map_empty,          // no voxel in it, or no free voxel
  map_too_large,      // more voxels than can be addressed or held
  no_map,             // a request came before any map
  start_outside,
  start_occupied,
  start_unknown,
  goal_outside,
  goal_occupied,
  goal_unknown,
  no_path,                // the goal is cut off from the start
  segment_blocked,        // a corridor segment touches an obstacle
  corridor_disjoint,      // consecutive polytopes share no ball
  trajectory_infeasible,  // no trajectory within the limits inside the corridor was found
  start_infeasible,       // the start state cannot be brought inside the corridor and limits
  solver_failed,          // the solver stopped without an answer: numerical trouble
  not_certified,          // the certificate does not hold
  deadline_exceeded,
  not_at_start,        // the vehicle is not where the trajectory begins
  tracking_lost,       // odometry is missing, stale or too far from the trajectory
  stage_silent,        // a stage did not answer in time
  io_failed,           // a file or a socket could not be used
  collision,           // the vehicle's body touches an obstacle, as planned or as flown
  cancelled,           // the asker wants no answer any more
  trajectory_blocked,  // the map shows an obstacle on a committed trajectory
  process_stalled,     // this process did not run for a while: stopped, suspended, or starved
  clock_set,           // a clock that stamps come from was set forward or back
  second_writer,       // a second program writes what one alone may write
  not_permitted,       // the asker may not do that here
};

std::string_view to_string(ErrorCode code);

/// @return every code once, for docs and for parsing
std::span<const ErrorCode> all_error_codes();

/// An expected failure: the code for machines, the sentence for people. The sentence names the
/// thing that is wrong and how to mend it.
struct Error {
  ErrorCode code = ErrorCode::invalid_input;
  std::string message;
};

}  // namespace goshawk
