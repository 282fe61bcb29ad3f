#include "goshawk/core/committed_trajectory.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace goshawk {
namespace {

constexpr double kSameState = 1e-6;  // [m], [m/s], [m/s^2]: the certificate's tolerance
// Beyond this no clock goes, and differences do not overflow.
constexpr std::int64_t kTimeBound_ns = 4'000'000'000'000'000'000;

Status check_stop(const CertifiedTrajectory& nominal, const StopPart& stop) {
  const double end_s = nominal.duration_s();
  if (!(stop.after_s > 0.0 && stop.after_s <= end_s)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("its stop part begins after {:.3g} s of a nominal part of {:.3g} s",
                            stop.after_s, end_s));
  }
  const FlatState left = nominal.trajectory().sample(stop.after_s);
  const FlatState begins = stop.trajectory.trajectory().sample(0.0);
  const double jump = largest_difference(left, begins);
  if (jump > kSameState) {
    return fail(ErrorCode::not_certified,
                fmt::format("its stop part begins {:.3g} (m, m/s, m/s^2) away from the nominal "
                            "part's state after {:.3g} s",
                            jump, stop.after_s));
  }
  if (stop.trajectory.ends_at_rest()) return success();
  return fail(ErrorCode::not_certified, "its stop part does not end at rest");
}

Status check(const Commitment& c) {
  if (c.stop) {
    if (auto status = check_stop(c.nominal, *c.stop); !status) return status;
  } else if (!c.nominal.ends_at_rest()) {
    return fail(ErrorCode::not_certified,
                "it does not end at rest: plan it to a stop or give it a stop part, so that it is "
                "safe when nothing follows");
  }
  if (!std::isfinite(c.yaw_rad)) return fail(ErrorCode::invalid_input, "its yaw is not finite");
  if (c.yaw_curve) {
    if (auto status = c.yaw_curve->check(); !status) return status;
  }
  if (c.start_time_ns >= -kTimeBound_ns && c.start_time_ns <= kTimeBound_ns) return success();
  return fail(ErrorCode::invalid_input, "its start time is outside the supported range");
}

}  // namespace

Result<CommittedTrajectory> CommittedTrajectory::make(Commitment content) {
  if (auto status = check(content); !status) {
    return fail(status.code(),
                fmt::format("trajectory {} refused: {}", content.id, status.error().message));
  }
  return CommittedTrajectory(std::move(content));
}

CommittedTrajectory::CommittedTrajectory(Commitment content) : content_(std::move(content)) {
  if (!content_.stop) return;
  to_rest_ = content_.nominal.trajectory().until(content_.stop->after_s);
  const int first = int(content_.nominal.polytopes().size());
  for (BezierPiece piece : content_.stop->trajectory.trajectory().pieces) {
    piece.polytope += first;
    to_rest_.pieces.push_back(piece);
  }
}

std::vector<Polytope> CommittedTrajectory::flown_polytopes() const {
  std::vector<Polytope> polytopes = content_.nominal.polytopes();
  if (content_.stop) {
    for (Polytope more : content_.stop->trajectory.polytopes()) {
      if (!more.always_valid()) {  // its interval counts from the stop part's start
        more.valid_from_s += content_.stop->after_s;
        more.valid_until_s += content_.stop->after_s;
      }
      polytopes.push_back(std::move(more));
    }
  }
  return polytopes;
}

}  // namespace goshawk
