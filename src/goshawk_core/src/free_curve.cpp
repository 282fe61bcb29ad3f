#include "goshawk/core/free_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ball_proof.hpp"

namespace goshawk {
namespace {

using Points = Points3<6>;

// Halving a piece this often leaves less than kTouch_m of any piece that a grid can hold.
constexpr int kDeepest = 48;
// Parts looked at for one piece; a curve that needs more runs along a surface within kTouch_m.
constexpr int kMostParts = 100'000;
// [voxels] beyond this no grid reaches, and numbers do not tell voxels apart.
constexpr double kFarthest = 1e12;
constexpr double kNoMotion = 1e-6;  // [m/s], [m/s^2]
// Boxes that cover more rows are halved before their voxels are looked at.
constexpr int kManyRows = 64;

struct Span {
  int first;
  int last;
};

/// The voxels of one axis that an interval may lie in. Two ways only if it is within the touch
/// of one face: below that face, or above it.
struct Ways {
  std::array<Span, 2> spans;
  int count;
};

// Voxels beyond the grid need no more than one index on each side of it.
int index_within(double value, int size) {
  return int(std::clamp(value, -1.0, double(size)));
}

Ways ways_of(double lo, double hi, double touch, int size) {
  const double first = std::floor(lo + touch);
  const double last = std::ceil(hi - touch) - 1.0;
  if (first <= last) return {{{{index_within(first, size), index_within(last, size)}, {}}}, 1};
  const int above = index_within(first, size);
  const int below = index_within(first - 1.0, size);
  return {{{{below, below}, {above, above}}}, 2};
}

std::optional<Index3> blocked_in_row(const FreeSpace::View& space, Span x, int y, int z) {
  const Index3 size = space.grid->grown.size();
  if (x.first < 0) return Index3{-1, y, z};
  if (x.last >= size.x) return Index3{size.x, y, z};
  return first_blocked(space, x.first, x.last, y, z);
}

std::optional<Index3> blocked_in(const FreeSpace::View& space, Span x, Span y, Span z) {
  const Index3 size = space.grid->grown.size();
  for (int k = z.first; k <= z.last; ++k) {
    for (int j = y.first; j <= y.last; ++j) {
      if (j < 0 || k < 0 || j >= size.y || k >= size.z) return Index3{x.first, j, k};
      if (const auto voxel = blocked_in_row(space, x, j, k)) return voxel;
    }
  }
  return {};
}

/// The two halves of a curve, by de Casteljau's algorithm.
void halve(const Points& curve, Points& left, Points& right) {
  right = curve;
  for (int level = 0; level < 6; ++level) {
    left.col(level) = right.col(0);
    for (int i = 0; i < 5 - level; ++i) right.col(i) = 0.5 * (right.col(i) + right.col(i + 1));
  }
}

class Prover {
 public:
  /// @param rest [voxels] where the curve begins at rest
  Prover(const FreeSpace::View& space, double touch, const std::optional<Vec3>& rest)
      : space_(space), touch_(touch), ball_(space, touch, rest) {}

  /// @param curve [voxels] @param begin, end of it in the piece's own time, 0 to 1
  /// @return whether it is free; else obstruction() has the first place
  bool prove(const Points& curve, double begin, double end, int depth = 0) {
    const Vec3 lo = curve.rowwise().minCoeff(), hi = curve.rowwise().maxCoeff();
    const Index3 size = space_.grid->grown.size();
    const std::array ways{ways_of(lo.x(), hi.x(), touch_, size.x),
                          ways_of(lo.y(), hi.y(), touch_, size.y),
                          ways_of(lo.z(), hi.z(), touch_, size.z)};
    const bool last_chance = depth == kDeepest || ++parts_ > kMostParts;
    if (!last_chance && rows_of(ways) > kManyRows) return prove_halves(curve, begin, end, depth);
    std::optional<Index3> voxel;
    for (int i = 0; i < ways[0].count; ++i) {
      for (int j = 0; j < ways[1].count; ++j) {
        for (int k = 0; k < ways[2].count; ++k) {
          voxel = blocked_in(space_, ways[0].spans[i], ways[1].spans[j], ways[2].spans[k]);
          if (!voxel) return true;
        }
      }
    }
    bool hopeless = is_inside_one(ways);
    if (space_.asks_for_raw) {  // the voxels are coarse: it may be free all the same
      if (ball_.holds(curve)) return true;
      const auto near = ball_.too_near(curve.col(0));
      hopeless = near.has_value();
      voxel = near ? near : ball_.too_near(curve.col(5)).value_or(*voxel);
    }
    if (!last_chance && !hopeless) return prove_halves(curve, begin, end, depth);
    obstruction_ = Obstruction{begin, *voxel};
    return false;
  }

  const Obstruction& obstruction() const { return obstruction_; }

 private:
  bool prove_halves(const Points& curve, double begin, double end, int depth) {
    Points left, right;
    halve(curve, left, right);
    const double middle = 0.5 * (begin + end);
    return prove(left, begin, middle, depth + 1) && prove(right, middle, end, depth + 1);
  }

  static int rows_of(const std::array<Ways, 3>& ways) {
    const auto width = [](const Ways& w) { return w.spans[0].last - w.spans[0].first + 1; };
    return width(ways[1]) * width(ways[2]);
  }

  // The whole curve in one voxel, which is blocked: shorter parts will not be free.
  static bool is_inside_one(const std::array<Ways, 3>& ways) {
    return std::ranges::all_of(
        ways, [](const Ways& w) { return w.count == 1 && w.spans[0].first == w.spans[0].last; });
  }

  FreeSpace::View space_;
  double touch_;
  BallProof ball_;
  int parts_ = 0;
  Obstruction obstruction_;
};

std::optional<Obstruction> obstruction_of_part(const FreeSpace::View& space,
                                               const BezierPiece& piece, double begin, double end,
                                               const std::optional<Vec3>& rest = {}) {
  const auto& g = space.grid->geometry;
  Points curve = (piece.control_points.colwise() - g.origin_map) / g.resolution_m;
  // NaN as well: neither is anywhere in a grid.
  if (!(curve.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < kFarthest)) {
    return Obstruction{begin * piece.duration_s, {-1, -1, -1}};
  }
  // Cut to [begin, end] by blossoming: de Casteljau to one end, then to the other.
  for (int side = 0; side < 2; ++side) {
    if (side == 0 ? begin <= 0.0 : end >= 1.0) continue;
    const double tau = side == 0 ? begin : (end - begin) / (1.0 - begin);
    Points kept = curve, work = curve;
    for (int level = 0; level < 6; ++level) {
      if (side == 0) {
        kept.col(5 - level) = work.col(5 - level);
      } else {
        kept.col(level) = work.col(0);
      }
      for (int i = 0; i < 5 - level; ++i) {
        work.col(i) = (1.0 - tau) * work.col(i) + tau * work.col(i + 1);
      }
    }
    curve = kept;
  }
  Prover prover(space, kTouch_m / g.resolution_m, rest);
  if (prover.prove(curve, begin, end)) return {};
  Obstruction found = prover.obstruction();
  found.time_s *= piece.duration_s;
  return found;
}

std::optional<Obstruction> obstruction_of(const FreeSpace::View& space, const BezierPiece& curve,
                                          double from_s, double to_s) {
  const double begin = std::clamp(from_s / curve.duration_s, 0.0, 1.0);
  const double end = std::clamp(to_s / curve.duration_s, begin, 1.0);
  return obstruction_of_part(space, curve, begin, end);
}

// [voxels] where the trajectory begins, if it begins at rest.
std::optional<Vec3> rest_of(const FreeSpace::View& space, const Trajectory& trajectory) {
  const FlatState start = trajectory.sample(0.0);
  if (start.velocity.norm() > kNoMotion || start.acceleration.norm() > kNoMotion) return {};
  return space.grid->geometry.to_grid(start.position);
}

std::optional<Obstruction> obstruction_of(const FreeSpace::View& space,
                                          const Trajectory& trajectory, double from_s,
                                          double to_s) {
  std::optional<Vec3> rest;
  if (space.asks_for_raw) rest = rest_of(space, trajectory);
  double begin_s = 0.0;
  for (const auto& piece : trajectory.pieces) {
    const double from = std::max(0.0, (from_s - begin_s) / piece.duration_s);
    const double to = std::min(1.0, (to_s - begin_s) / piece.duration_s);
    if (from < 1.0 && from <= to) {
      if (auto found = obstruction_of_part(space, piece, from, to, rest)) {
        found->time_s += begin_s;
        return found;
      }
    }
    begin_s += piece.duration_s;
  }
  return {};
}

Status check_in(const FreeSpace::View& space, const CommittedTrajectory& committed, double from_s) {
  const auto found =
      obstruction_of(space, committed.flown(), from_s, std::numeric_limits<double>::infinity());
  if (!found) return success();
  return fail(ErrorCode::trajectory_blocked,
              fmt::format("trajectory {} is blocked {:.3g} s after its start: {}", committed.id(),
                          found->time_s, to_text(*space.grid, *found)));
}

}  // namespace

std::optional<Obstruction> find_obstruction(const VoxelGrid& grid, const BezierPiece& curve,
                                            double from_s, double to_s) {
  return obstruction_of({.grid = &grid}, curve, from_s, to_s);
}

std::optional<Obstruction> find_obstruction(const VoxelGrid& grid, const Trajectory& trajectory,
                                            double from_s, double to_s) {
  return obstruction_of({.grid = &grid}, trajectory, from_s, to_s);
}

std::optional<Obstruction> find_obstruction(const FreeSpace& space, const BezierPiece& curve,
                                            double from_s, double to_s) {
  return obstruction_of(space.view(), curve, from_s, to_s);
}

std::optional<Obstruction> find_obstruction(const FreeSpace& space, const Trajectory& trajectory,
                                            double from_s, double to_s) {
  return obstruction_of(space.view(), trajectory, from_s, to_s);
}

std::string to_text(const VoxelGrid& grid, const Obstruction& found) {
  const std::string place = to_text(grid.geometry.center(found.voxel));
  if (!grid.grown.contains(found.voxel)) {
    return fmt::format("map {} has its edge at {} m", grid.version, place);
  }
  const bool unseen_cube = !grid.unknown_is_occupied && !grid.raw.empty() &&
                           !grid.raw.get(found.voxel) && !grid.is_known(found.voxel);
  if (!grid.grown.get(found.voxel) || unseen_cube) {
    return fmt::format("map {} has space that was never seen within {:.3g} m of {} m", grid.version,
                       grid.inflation_m, place);
  }
  const bool unknown = grid.unknown_is_occupied && !grid.is_known(found.voxel);
  return fmt::format("map {} has {} at {} m", grid.version,
                     unknown ? "unknown space" : "an obstacle", place);
}

Status check_against(const VoxelGrid& grid, const CommittedTrajectory& committed, double from_s) {
  return check_in({.grid = &grid}, committed, from_s);
}

Status check_against(const FreeSpace& space, const CommittedTrajectory& committed, double from_s) {
  return check_in(space.view(), committed, from_s);
}

}  // namespace goshawk
