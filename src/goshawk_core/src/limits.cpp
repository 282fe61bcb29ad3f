#include "goshawk/core/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk {
namespace {

double norm_of(const Vec3& v, LimitNorm norm, double limit, double vertical) {
  switch (norm) {
    case LimitNorm::euclidean:
      return v.norm() / limit;
    case LimitNorm::per_axis:
      return v.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / limit;
    case LimitNorm::horizontal_vertical:
      break;
  }
  double use = v.head<2>().norm() / limit;
  const double vertical_use = std::abs(v.z()) / (vertical > 0.0 ? vertical : limit);
  return std::isnan(use) || use > vertical_use ? use : vertical_use;
}

}  // namespace

Status Limits::check() const {
  std::string faults;
  const auto positive = [&](const char* name, double value) {
    if (std::isfinite(value) && value > 0.0) return;
    faults += fmt::format("{}{} is {:.6g}", faults.empty() ? "" : "; ", name, value);
  };
  positive("v_max_m_s", v_max_m_s);
  positive("a_max_m_s2", a_max_m_s2);
  const auto optional = [&](const char* name, double value) {
    if (value != 0.0) positive(name, value);
  };
  optional("j_max_m_s3", j_max_m_s3);
  optional("v_max_vertical_m_s", v_max_vertical_m_s);
  optional("a_max_vertical_m_s2", a_max_vertical_m_s2);
  if (faults.empty()) return success();
  return fail(ErrorCode::invalid_limits, faults + ": a limit must be finite and above zero");
}

double Limits::speed_usage(const Vec3& velocity) const {
  return norm_of(velocity, norm, v_max_m_s, v_max_vertical_m_s);
}

double Limits::acceleration_usage(const Vec3& acceleration) const {
  return norm_of(acceleration, norm, a_max_m_s2, a_max_vertical_m_s2);
}

StartAllowance StartAllowance::of(const FlatState& start, const Limits& limits) {
  constexpr double kReaction_s = 0.1;
  const double v = limits.speed_usage(start.velocity);
  const double a = limits.acceleration_usage(start.acceleration);
  StartAllowance allowance;
  if (!(v > 1.0 + kLimitRounding || a > 1.0 + kLimitRounding)) return allowance;
  const double v_to_a_s = limits.v_max_m_s / limits.a_max_m_s2;
  allowance.acceleration = std::max(1.0, a);
  allowance.speed = std::max(1.0, v) + allowance.acceleration * kReaction_s / v_to_a_s;
  allowance.until_s = 2.0 * std::max(0.0, v - 1.0) * v_to_a_s + 0.5;
  return allowance;
}

}  // namespace goshawk
