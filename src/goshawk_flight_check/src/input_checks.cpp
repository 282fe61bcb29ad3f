#include "input_checks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk::flight_check {
namespace {

constexpr double kFarthest_m = 1e6;

std::string sample_fault(const Sample& s, const Sample* previous) {
  if (!std::isfinite(s.t_s) || !s.position_map.allFinite() || !s.q_map_base.coeffs().allFinite()) {
    return "has a number that is not finite";
  }
  if (s.position_map.cwiseAbs().maxCoeff() > kFarthest_m) return "lies beyond 1e6 m";
  if (std::abs(s.q_map_base.norm() - 1.0) > 1e-3) return "has a quaternion without unit length";
  if (previous != nullptr && s.t_s < previous->t_s) return "goes back in time";
  return {};
}

}  // namespace

Status check_track(std::span<const Sample> track) {
  if (track.empty()) {
    return fail(ErrorCode::invalid_input,
                "the flight has no sample to judge: record its odometry, or sample its trajectory");
  }
  for (std::size_t i = 0; i < track.size(); ++i) {
    const std::string fault = sample_fault(track[i], i > 0 ? &track[i - 1] : nullptr);
    if (fault.empty()) continue;
    return fail(ErrorCode::invalid_input,
                fmt::format("sample {} of the flight {}: mend the recording", i, fault));
  }
  return success();
}

Status check_options(const Options& options) {
  if (options.tolerance_m >= 1e-5 && options.tolerance_m <= 1.0) return success();
  return fail(ErrorCode::invalid_parameter,
              fmt::format("tolerance_m is {} m, outside of [1e-5, 1]", options.tolerance_m));
}

}  // namespace goshawk::flight_check
