#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "goshawk/core/vector.hpp"

namespace goshawk::guard {

/// Which message brought a plan. In the order of the constants KIND_* of GuardVerdict.
enum class PlanKind : std::uint8_t { path, trajectory, polynomial, bspline };
std::string_view to_string(PlanKind kind);  // "a path"

/// A polyline to follow as fast as the limits allow. Frame `map`.
struct Waypoints {
  std::vector<Vec3> points_map;  // [m]
};

/// Where the vehicle is to be, and when.
struct Sample {
  double t_s = 0.0;                       // [s] after the plan's start, growing
  Vec3 position = Vec3::Zero();           // [m] map
  std::optional<Vec3> velocity = {};      // [m/s]
  std::optional<Vec3> acceleration = {};  // [m/s^2]
};
struct Samples {
  std::vector<Sample> samples;
};

/// x[0] + x[1] t + x[2] t^2 ..., t [s] from the piece's own start.
struct Polynomials {
  struct Piece {
    double duration_s = 0.0;
    std::array<std::vector<double>, 3> coefficients = {};  // x, y, z
  };
  std::vector<Piece> pieces;
};

/// Begins at knots_s[degree] and ends at knots_s[n], n control points.
struct Bspline {
  int degree = 3;
  std::vector<double> knots_s = {};           // n + degree + 1, not falling
  std::vector<Vec3> control_points_map = {};  // [m] n
};

/// What another planner wants flown.
struct Plan {
  PlanKind kind = PlanKind::path;
  std::optional<std::int64_t> start_time_ns = {};  // none: as soon as it may
  std::variant<Waypoints, Samples, Polynomials, Bspline> shape;
};

}  // namespace goshawk::guard
