#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bezier_basis.hpp"
#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {
namespace {

Error wrong_spline(const std::string& why) {
  return fail(ErrorCode::invalid_input, "the B-spline " + why);
}

constexpr double kSameKnot_s = 1e-9;

Status check_spline(const Bspline& s) {
  const std::size_t n = s.control_points_map.size();
  if (s.degree < 2 || s.degree > 5) {
    return wrong_spline(fmt::format("has degree {}; 2 to 5 can be flown", s.degree));
  }
  if (n <= std::size_t(s.degree) || n > kMostPieces) {
    return wrong_spline(
        fmt::format("has {} control points; {} to {} are allowed", n, s.degree + 1, kMostPieces));
  }
  if (s.knots_s.size() != n + std::size_t(s.degree) + 1) {
    return wrong_spline(
        fmt::format("has {} knots for {} control points of degree {}: {} are "
                    "needed",
                    s.knots_s.size(), n, s.degree, n + std::size_t(s.degree) + 1));
  }
  for (std::size_t i = 0; i < s.knots_s.size(); ++i) {
    if (!std::isfinite(s.knots_s[i]))
      return wrong_spline(fmt::format("has a knot that is not finite: knot {}", i));
    if (i > 0 && s.knots_s[i] < s.knots_s[i - 1]) {
      return wrong_spline(fmt::format("has knots that fall, at knot {}", i));
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (is_within_reach(s.control_points_map[i])) continue;
    return wrong_spline(
        fmt::format("has a control point that is not finite, or beyond {:g} km: "
                    "control point {}",
                    1e-3 * kFarthest_m, i));
  }
  return success();
}

// The blossom of the span between knots k and k + 1 at `arguments` (de Boor's algorithm with one
// argument a level): inserts each of them as a knot.
Vec3 blossom(const Bspline& s, std::size_t k, std::span<const double> arguments) {
  const std::size_t degree = std::size_t(s.degree);
  std::array<Vec3, 6> d;
  for (std::size_t j = 0; j <= degree; ++j) d[j] = s.control_points_map[k - degree + j];
  for (std::size_t r = 1; r <= degree; ++r) {
    for (std::size_t j = degree; j >= r; --j) {
      const double low = s.knots_s[k - degree + j], high = s.knots_s[k + 1 + j - r];
      const double share = (arguments[r - 1] - low) / (high - low);
      d[j] = (1.0 - share) * d[j - 1] + share * d[j];
    }
  }
  return d[degree];
}

}  // namespace

Result<Curve> curve_of(const Bspline& spline) {
  if (auto status = check_spline(spline); !status) return status.error();
  const std::size_t degree = std::size_t(spline.degree);
  Curve curve;
  for (std::size_t k = degree; k < spline.control_points_map.size(); ++k) {
    const double begin = spline.knots_s[k], end = spline.knots_s[k + 1];
    if (!(end - begin > kSameKnot_s)) continue;
    if (end - begin < kLeastPiece_s) {
      return wrong_spline(
          fmt::format("has knots {} and {} that are {:.3g} s apart: nothing, or "
                      "{:g} s and more, can be flown",
                      k, k + 1, end - begin, kLeastPiece_s));
    }
    std::vector<Vec3> points;
    for (std::size_t i = 0; i <= degree; ++i) {
      std::array<double, 5> arguments;
      std::fill_n(arguments.begin(), degree - i, begin);
      std::fill_n(arguments.begin() + std::ptrdiff_t(degree - i), i, end);
      points.push_back(blossom(spline, k, arguments));
    }
    curve.trajectory.pieces.push_back(quintic(std::move(points), end - begin));
  }
  if (curve.trajectory.pieces.empty()) return wrong_spline("lasts no time: its knots are equal");
  if (auto status = curve.trajectory.check(); !status) return wrong_spline(status.error().message);
  return curve;
}

}  // namespace goshawk::guard
