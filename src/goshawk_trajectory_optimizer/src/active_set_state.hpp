#pragma once

#include "lanes.hpp"

// The working memory of ActiveSetSolver, laid out for its kernels. Plain data, as in
// spline_state.hpp.
namespace goshawk::trajectory_optimizer {

/// normal . y <= bound on a point y = map (two knots), with its multiplier. A face of a polytope,
/// or the half-space that touches a limit if a control point went through it.
struct Constraint {
  Lanes normal;   // x, y, z, 0
  double map[6];  // of p, v, a of `knot` and of the next
  int knot;
  double bound;
  double multiplier;
  long long limit;  // the ball that it touches; -1: a face, or a limit that is a plane
};

/// A control point y = p + beta v + gamma a of one knot and its faces.
struct PricedPoint {
  int knot, begin, end;
  double map[3];
  double weight;  // by which its violations are compared: 1 / sqrt(map' H^-1 map)
};

/// The control points of one derivative of a piece, in units of the limit: |y| <= 1. A lane without
/// a point has a map of zero.
struct PricedLimits {
  Lanes map[6];
  Lanes weight;
};

inline constexpr int kMostNorms = 3;
inline constexpr int kDerivatives = 3;  // velocity, acceleration, jerk

struct PricedSet {
  PricedLimits* pieces = nullptr;               // one a piece; null: no such limit
  int norms = 1;                                // of each point
  double weights[kMostNorms][kMostNorms] = {};  // of the squared components in each norm
};

/// A block row of the Hessian of one axis, H = L D L': 3 x 3 blocks by rows.
struct KnotFactor {
  double inverse[9];     // D^-1
  double below[9];       // L's block to the knot before
  double variance[9];    // this knot's block of H^-1
  double covariance[9];  // rows: the next knot; columns: this one
};

struct ActiveSetState {
  int last = 0;                  // index of the last knot = number of pieces
  const double* jerk = nullptr;  // 36 a piece
  KnotFactor* factors = nullptr;
  Lanes* x = nullptr;         // 3 a knot: p, v, a; the ends are constant
  Lanes* free = nullptr;      // the same without constraints
  Lanes* work = nullptr;      // the same; zero at the ends
  Lanes* residual = nullptr;  // gradient of the Lagrangian
  PricedPoint* points = nullptr;
  int point_count = 0;
  FourFaces* faces = nullptr;
  PricedSet limits[kDerivatives];
  double face_tolerance = 0.0, limit_tolerance = 0.0;

  // The working set W, and M with M'M = (A H^-1 A')^-1, square, rows of `stride` doubles.
  Constraint* active = nullptr;
  int count = 0, capacity = 0, stride = 0;
  int cuts = 0;   // of balls, in W
  int turns = 0;  // cuts of balls that were cut already
  double* inverse_root = nullptr;
  double* column = nullptr;  // A H^-1 a
  double* image = nullptr;   // M times it
  double* change = nullptr;  // (A H^-1 A')^-1 A H^-1 a: how multipliers fall as the new one grows

  Constraint next;         // the constraint that is about to become active
  double violation = 0.0;  // of it; 0: none is violated
  double own = 0.0;        // a' H^-1 a
  double slope = 0.0;      // of its violation by its multiplier: a' H^-1 (a - A' change)
  double remainder = 0.0;  // sum |a - A' change|, only if that is small

  double objective = 0.0;
  double face_violation = 0.0, limit_violation = 0.0, dual_residual = 0.0, gap = 0.0;
};

struct ActiveSetKernels {
  bool (*factor)(ActiveSetState&);   // and the free minimum; false: not positive definite
  void (*weigh)(ActiveSetState&);    // the points' and limits' weights
  void (*place)(ActiveSetState&);    // x from the multipliers
  void (*price)(ActiveSetState&);    // the most violated constraint
  void (*reach)(ActiveSetState&);    // own and column of the next constraint
  void (*project)(ActiveSetState&);  // image, change, slope
  void (*turn)(ActiveSetState&);     // the next constraint, if its limit is active already
  void (*append)(ActiveSetState&);
  void (*drop)(ActiveSetState&, int index);
  void (*refine)(ActiveSetState&);   // multipliers, from what the active constraints miss
  void (*measure)(ActiveSetState&);  // objective, dual residual, gap
  void (*polish)(ActiveSetState&);   // x, after measure
};

/// For this processor: the same bits from each.
const ActiveSetKernels& active_set_kernels();

}  // namespace goshawk::trajectory_optimizer
