#include "goshawk/navigator/answer_check.hpp"

#include <fmt/format.h>

namespace goshawk::navigator {
namespace {

constexpr double kSame = 1e-6;        // [m], [m/s], [m/s^2]: the certificate's tolerance
constexpr double kNearRest_m = 0.05;  // a start that the search moved by no more is flown
constexpr double kSameGoal_m = 1e-3;

bool same(const Limits& a, const Limits& b) {
  return a.v_max_m_s == b.v_max_m_s && a.a_max_m_s2 == b.a_max_m_s2 && a.norm == b.norm &&
         a.j_max_m_s3 == b.j_max_m_s3 && a.v_max_vertical_m_s == b.v_max_vertical_m_s &&
         a.a_max_vertical_m_s2 == b.a_max_vertical_m_s2;
}

Status refuse(const std::string& why) {
  return fail(ErrorCode::not_certified, "the answer is not what was asked for: " + why);
}

}  // namespace

Status check_answer(const Commitment& answer, const PlanRequest& request,
                    const Shortfall& shortfall) {
  const CertifiedTrajectory& nominal = answer.nominal;
  if (!same(nominal.limits(), request.limits)) return refuse("it was planned with other limits");
  const FlatState begins = nominal.trajectory().sample(0.0);
  FlatState start = request.start;
  if (!request.start_time_ns && (begins.position - start.position).norm() <= kNearRest_m) {
    start.position = begins.position;
  }
  if (const double gap = largest_difference(begins, start); !(gap <= kSame)) {
    return refuse(fmt::format("it begins {:.3g} (m, m/s, m/s^2) from the start", gap));
  }
  const Vec3 ends = nominal.trajectory().sample(nominal.duration_s()).position;
  if (const double gap_m = (ends - request.goal.position).norm();
      !(gap_m <= shortfall.goal_moved_m + shortfall.beyond_m + kSameGoal_m)) {
    return refuse(fmt::format("it ends at {} m, {:.3g} m from the goal", to_text(ends), gap_m));
  }
  return success();
}

}  // namespace goshawk::navigator
