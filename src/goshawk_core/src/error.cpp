#include "goshawk/core/error.hpp"

#include <array>

namespace goshawk {
namespace {

struct CodeName {
  ErrorCode code;
  std::string_view name;
};

constexpr std::array kNames{
    CodeName{ErrorCode::ok, "ok"},
    CodeName{ErrorCode::invalid_input, "invalid_input"},
    CodeName{ErrorCode::invalid_parameter, "invalid_parameter"},
    CodeName{ErrorCode::invalid_limits, "invalid_limits"},
    CodeName{ErrorCode::wrong_frame, "wrong_frame"},
    CodeName{ErrorCode::map_unreadable, "map_unreadable"},
    CodeName{ErrorCode::map_malformed, "map_malformed"},
    CodeName{ErrorCode::map_empty, "map_empty"},
    CodeName{ErrorCode::map_too_large, "map_too_large"},
    CodeName{ErrorCode::no_map, "no_map"},
    CodeName{ErrorCode::start_outside, "start_outside"},
    CodeName{ErrorCode::start_occupied, "start_occupied"},
    CodeName{ErrorCode::start_unknown, "start_unknown"},
    CodeName{ErrorCode::goal_outside, "goal_outside"},
    CodeName{ErrorCode::goal_occupied, "goal_occupied"},
    CodeName{ErrorCode::goal_unknown, "goal_unknown"},
    CodeName{ErrorCode::no_path, "no_path"},
    CodeName{ErrorCode::segment_blocked, "segment_blocked"},
    CodeName{ErrorCode::corridor_disjoint, "corridor_disjoint"},
    CodeName{ErrorCode::trajectory_infeasible, "trajectory_infeasible"},
    CodeName{ErrorCode::start_infeasible, "start_infeasible"},
    CodeName{ErrorCode::solver_failed, "solver_failed"},
    CodeName{ErrorCode::not_certified, "not_certified"},
    CodeName{ErrorCode::deadline_exceeded, "deadline_exceeded"},
    CodeName{ErrorCode::not_at_start, "not_at_start"},
    CodeName{ErrorCode::tracking_lost, "tracking_lost"},
    CodeName{ErrorCode::stage_silent, "stage_silent"},
    CodeName{ErrorCode::io_failed, "io_failed"},
    CodeName{ErrorCode::collision, "collision"},
    CodeName{ErrorCode::cancelled, "cancelled"},
    CodeName{ErrorCode::trajectory_blocked, "trajectory_blocked"},
    CodeName{ErrorCode::process_stalled, "process_stalled"},
    CodeName{ErrorCode::clock_set, "clock_set"},
    CodeName{ErrorCode::second_writer, "second_writer"},
    CodeName{ErrorCode::not_permitted, "not_permitted"},
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
