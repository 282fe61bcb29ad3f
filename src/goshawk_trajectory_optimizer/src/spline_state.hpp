#pragma once

#include "lanes.hpp"

// The working memory of SplineSolver, laid out for its kernels. Plain data: the kernels are
// compiled for several instruction sets and must not instantiate anything that others share.
namespace goshawk::trajectory_optimizer {

/// What belongs to four constraints; weight (z / s) and dz are computed where they are needed: a
/// long trajectory has to fit into the processor's cache.
struct Row {
  Lanes s, z;      // slack and multiplier
  Lanes residual;  // of the constraint and s; after the corrector ds
  Lanes inverse_s;
  Lanes target;  // what s z is to become: ds dz of the predictor, then what dz is made of
};

/// A control point y = p + beta v + gamma a of one knot, rows begin .. end - 1 and their planes,
/// from `planes` on. Points with the same faces share them.
struct FaceRange {
  int knot, begin, end, planes;
  double map[3];  // 1, beta, gamma
};

inline constexpr int kMostRows = 3;

/// One limit on the four (or fewer) control points of a derivative of a piece:
///   |y|_r^2 <= e          (velocity)        r: a weighted norm, e = e1 eta + e0
///   |y|_r^2 / e <= e      (acceleration, jerk)
/// y in units of the limit. A lane without a point has a map of zero and e = 1.
struct LimitLanes {
  Lanes map[6];  // of p, v, a of the first knot and of the second
  Lanes e1, e0;
  Lanes y[3];
  Lanes e, inverse_e;
  struct LimitRow : Row {
    Lanes slope_e;  // of the constraint, by eta
  } row[kMostRows];
};

/// The limit on one derivative, all pieces.
struct LimitSet {
  LimitLanes* lanes = nullptr;        // one a piece; null: no such limit
  int rows = 1;                       // norms of each point
  double weights[kMostRows][3] = {};  // of the components of y in each row's norm
};

/// Sums over all points of one knot. Blocks of the Hessian are symmetric 3 x 3 matrices kept as
/// xx xy xz yy | yz zz - -; the knot's are pp, vp, ap, vv, av, aa.
struct KnotSums {
  Lanes block[6][2];
  Lanes border[3];  // Hessian by the knot and eta
  Lanes cost[3];    // gradient of the cost
  Lanes dual[3];    // gradient of the constraints times multipliers
  Lanes pull[3];    // right-hand side from the constraints
};

/// Blocks of the Hessian by the second knot of a piece (rows) and the first: pp, pv, pa, vp, ...
struct PieceSums {
  Lanes block[9][2];
};

/// A block column of the factors L D L': rows 0..8 the diagonal block, row 9 the border, rows
/// 12..20 the block below, row 21 the border again (what is below then has the next panel's form).
struct Panel {
  Lanes u[9][6];           // columns of L D
  Lanes transposed[9][2];  // row j of L's diagonal block, left of the diagonal
  Lanes inverse_d[3];
};

/// Everything a kernel works on.
struct SplineState {
  int last = 0;  // index of the last knot = number of pieces
  bool scale = true;
  bool ends_move = false;
  int rows = 1;                       // of each limit point
  double weights[kMostRows][3] = {};  // of the components of y in each row's norm
  int face_points = 0;
  double degree = 1.0;  // number of products s z
  double time_weight = 0.0;

  Lanes* x = nullptr;  // 3 a knot: p, v, a
  Lanes* dx = nullptr;
  const Lanes* start_rate = nullptr;
  const Lanes* goal_rate = nullptr;
  const double* jerk = nullptr;  // 36 a piece
  FaceRange* ranges = nullptr;
  const FourFaces* planes = nullptr;
  Row* faces = nullptr;
  LimitSet velocity, acceleration, jerk_limit;
  KnotSums* knots = nullptr;
  PieceSums* pieces = nullptr;
  Panel* panels = nullptr;
  Lanes* rhs = nullptr;  // 3 a knot, packed: nine values

  double eta = 1.0, deta = 0.0;
  double step = 0.0;  // that x has taken already and the rows take with the next pass
  double dual_eta = 0.0, pull_eta = 0.0, hessian_eta = 0.0, corner = 0.0;
  double objective = 0.0, gap = 0.0, primal_residual = 0.0, dual_residual = 0.0;
  double multiplier_residual = 0.0;  // sum of |G'z| over the unknowns
  double proof = 0.0;                // z' (f + s)
  double face_violation = 0.0, limit_violation = 0.0;
  double reach = 1.0;    // step of the predictor to the boundary, at most 1
  double trust = 1.0;    // in the predictor's second order: 0 or 1
  double product = 0.0;  // ds'dz of the predictor
};

/// The steps of an iteration, each a pass over the state.
struct SplineKernels {
  bool (*smooth)(SplineState&, double pull);   // one Newton step of the cost and the guess' pull
  void (*evaluate)(SplineState&);              // residuals alone, of slacks of 1
  void (*linearise)(SplineState&);             // takes the step; residuals and reduced Hessian
  bool (*factor)(SplineState&);                // false: not positive definite
  double (*predict)(SplineState&);             // the step to the boundary
  double (*correct)(SplineState&, double mu);  // the same; ds and dz are final
  void (*apply)(SplineState&, double step);
};

/// For this processor: the same bits from each.
const SplineKernels& spline_kernels();

}  // namespace goshawk::trajectory_optimizer
