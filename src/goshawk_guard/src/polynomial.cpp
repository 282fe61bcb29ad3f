#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezier_basis.hpp"
#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {
namespace {

constexpr int kMostDegree = 9;
constexpr int kMostHalvings = 4;

Error wrong_polynomial(std::size_t piece, const std::string& why) {
  return fail(ErrorCode::invalid_input, fmt::format("polynomial piece {} {}", piece, why));
}

Status check_piece(const Polynomials::Piece& piece, std::size_t k) {
  if (!(std::isfinite(piece.duration_s) && piece.duration_s >= kLeastPiece_s)) {
    return wrong_polynomial(k, fmt::format("lasts {:.3g} s: a finite time of {:g} s or more is "
                                           "needed",
                                           piece.duration_s, kLeastPiece_s));
  }
  for (const auto& coefficients : piece.coefficients) {
    if (coefficients.empty() || coefficients.size() > std::size_t(kMostDegree) + 1) {
      return wrong_polynomial(k, fmt::format("has {} coefficients for a coordinate; 1 to {} are "
                                             "allowed",
                                             coefficients.size(), kMostDegree + 1));
    }
    if (!std::ranges::all_of(coefficients, [](double c) { return std::isfinite(c); })) {
      return wrong_polynomial(k, "has a coefficient that is not finite");
    }
  }
  return success();
}

/// The state at an end of a Bezier curve of any degree.
FlatState end_state(std::span<const Vec3> points, double duration_s, bool at_end) {
  const std::size_t n = points.size();
  const double degree = double(n - 1), sign = at_end ? -1.0 : 1.0;
  const Vec3& p0 = points[at_end ? n - 1 : 0];
  const Vec3& p1 = points[at_end ? n - 2 : 1];
  const Vec3& p2 = points[at_end ? n - 3 : 2];
  return {
      .position = p0,
      .velocity = sign * degree / duration_s * (p1 - p0),
      .acceleration = degree * (degree - 1.0) / (duration_s * duration_s) * (p2 - 2.0 * p1 + p0)};
}

class Fit {
 public:
  explicit Fit(Curve& curve) : curve_(curve) {}

  // @return whether it came near enough
  bool add(const std::vector<Vec3>& points, double duration_s, int halvings) {
    const BezierPiece piece = BezierPiece::between(end_state(points, duration_s, false),
                                                   end_state(points, duration_s, true), duration_s);
    std::vector<Vec3> raised_points;
    for (int i = 0; i < 6; ++i) raised_points.push_back(piece.control_points.col(i));
    while (raised_points.size() < points.size()) raised_points = raised(raised_points);
    double off_m = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      off_m = std::max(off_m, (points[i] - raised_points[i]).norm());
    }
    if (off_m <= kPolynomialWithin_m) {
      curve_.trajectory.pieces.push_back(piece);
      curve_.deviation_m = std::max(curve_.deviation_m, off_m);
      return true;
    }
    if (halvings == 0) return false;
    const Halves halves = halved(points);
    return add(halves.first, duration_s / 2.0, halvings - 1) &&
           add(halves.second, duration_s / 2.0, halvings - 1);
  }

 private:
  Curve& curve_;
};

}  // namespace

Result<Curve> curve_of(const Polynomials& polynomials) {
  const std::size_t n = polynomials.pieces.size();
  if (n == 0 || n > kMostPieces) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("the plan has {} polynomial pieces; 1 to {} are allowed", n, kMostPieces));
  }
  Curve curve;
  Fit fit(curve);
  for (std::size_t k = 0; k < n; ++k) {
    const auto& piece = polynomials.pieces[k];
    if (auto status = check_piece(piece, k); !status) return status.error();
    int degree = 5;
    for (const auto& c : piece.coefficients) degree = std::max(degree, int(c.size()) - 1);
    std::vector<Vec3> points(std::size_t(degree) + 1);
    for (int axis = 0; axis < 3; ++axis) {
      const auto numbers =
          bernstein(piece.coefficients[std::size_t(axis)], piece.duration_s, degree);
      for (std::size_t i = 0; i < points.size(); ++i) points[i][axis] = numbers[i];
    }
    for (const Vec3& p : points) {
      if (is_within_reach(p)) continue;
      return wrong_polynomial(
          k, fmt::format("may leave the {:g} km around the origin", 1e-3 * kFarthest_m));
    }
    if (degree == 5) {
      curve.trajectory.pieces.push_back(quintic(std::move(points), piece.duration_s));
    } else if (!fit.add(points, piece.duration_s, kMostHalvings)) {
      return fail(ErrorCode::trajectory_infeasible,
                  fmt::format("polynomial piece {} has degree {} and cannot be approached to {:g} "
                              "m by quintics: send shorter pieces",
                              k, degree, kPolynomialWithin_m));
    }
  }
  if (curve.trajectory.pieces.size() <= kMostPieces) return curve;
  return fail(ErrorCode::invalid_input,
              fmt::format("the polynomials need {} quintic pieces; {} are allowed",
                          curve.trajectory.pieces.size(), kMostPieces));
}

}  // namespace goshawk::guard
