#include "goshawk/core/error.hpp"

#include <array>

namespace goshawk {
namespace {

struct Named {
  ErrorCode code;
  std::string_view name;
};

constexpr std::array kNames{
    Named{ErrorCode::ok, "ok"},
    Named{ErrorCode::invalid_input, "invalid_input"},
    Named{ErrorCode::invalid_parameter, "invalid_parameter"},
    Named{ErrorCode::invalid_limits, "invalid_limits"},
    Named{ErrorCode::wrong_frame, "wrong_frame"},
    Named{ErrorCode::map_unreadable, "map_unreadable"},
    Named{ErrorCode::map_malformed, "map_malformed"},
    Named{ErrorCode::map_empty, "map_empty"},
    Named{ErrorCode::map_too_large, "map_too_large"},
    Named{ErrorCode::no_map, "no_map"},
    Named{ErrorCode::start_outside, "start_outside"},
    Named{ErrorCode::start_occupied, "start_occupied"},
    Named{ErrorCode::start_unknown, "start_unknown"},
    Named{ErrorCode::goal_outside, "goal_outside"},
    Named{ErrorCode::goal_occupied, "goal_occupied"},
    Named{ErrorCode::goal_unknown, "goal_unknown"},
    Named{ErrorCode::no_path, "no_path"},
    Named{ErrorCode::segment_blocked, "segment_blocked"},
    Named{ErrorCode::corridor_disjoint, "corridor_disjoint"},
    Named{ErrorCode::trajectory_infeasible, "trajectory_infeasible"},
    Named{ErrorCode::start_infeasible, "start_infeasible"},
    Named{ErrorCode::solver_failed, "solver_failed"},
    Named{ErrorCode::not_certified, "not_certified"},
    Named{ErrorCode::deadline_exceeded, "deadline_exceeded"},
    Named{ErrorCode::not_at_start, "not_at_start"},
    Named{ErrorCode::tracking_lost, "tracking_lost"},
    Named{ErrorCode::stage_silent, "stage_silent"},
    Named{ErrorCode::io_failed, "io_failed"},
    Named{ErrorCode::collision, "collision"},
    Named{ErrorCode::cancelled, "cancelled"},
    Named{ErrorCode::trajectory_blocked, "trajectory_blocked"},
    Named{ErrorCode::process_stalled, "process_stalled"},
    Named{ErrorCode::clock_set, "clock_set"},
    Named{ErrorCode::second_writer, "second_writer"},
};

constexpr auto kCodes = [] {
  std::array<ErrorCode, kNames.size()> codes{};
  for (std::size_t i = 0; i < kNames.size(); ++i) codes[i] = kNames[i].code;
  return codes;
}();

static_assert(
    [] {
      for (std::size_t i = 0; i < kNames.size(); ++i) {
        if (static_cast<std::size_t>(kNames[i].code) != i) return false;
      }
      return true;
    }(),
    "kNames follows the order of ErrorCode");

}  // namespace

std::string_view to_string(ErrorCode code) {
  return kNames.at(static_cast<std::size_t>(code)).name;
}

std::span<const ErrorCode> all_error_codes() {
  return kCodes;
}

}  // namespace goshawk
