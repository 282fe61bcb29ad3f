// The iteration's passes over a SplineState. Included by one source for each instruction set,
// inside an unnamed namespace: nothing here may be shared between them.
//
// The problem is: minimise f(x) subject to g_i(x) <= 0, x all knots and eta. With a slack s_i and a
// multiplier z_i for each row, r_i = g_i + s_i and G the rows' gradients, Newton's step of the
// perturbed optimality conditions is
//
//   (H_f + sum z_i H_gi + G' diag(z / s) G) dx = -grad f - G' (t + z / s r)
//   ds = -r - G dx
//   dz = t - z - z / s ds
//
// with t = 0 in the predictor and t = (mu - ds dz) / s in the corrector, ds and dz the predictor's
// (Mehrotra). linearise() makes the matrix, factor() factors it, predict() and correct() solve.

// s += step ds, z += step dz: rows follow x in the next pass, which reads them anyway.
GOSHAWK_INLINE void take_step(Row& row, double step) {
  const Lanes ds = row.residual;
  const Lanes dz = row.target - row.z - row.z * row.inverse_s * ds;
  row.s += step * ds;
  row.z += step * dz;
}

#include "kernel_faces.inl"
#include "kernel_factor.inl"
#include "kernel_limits.inl"

// The cost alone: objective = w eta + 1/2 sum over pieces of x' Q x, its gradient Q x and the Hessian
// Q, the same for the three axes. All other sums become zero.
void start_sums(SplineState& w) {
  w.objective = w.time_weight * w.eta;
  for (int k = 0; k <= w.last; ++k) {
    KnotSums& j = w.knots[k];
    for (auto& block : j.block) block[0] = block[1] = Lanes{};
    for (int b = 0; b < 3; ++b) j.border[b] = j.cost[b] = j.dual[b] = j.pull[b] = Lanes{};
  }
  constexpr int kRow[6] = {0, 1, 2, 1, 2, 2};
  constexpr int kColumn[6] = {0, 0, 0, 1, 1, 2};
  constexpr Lanes kUnit0 = {1.0, 0.0, 0.0, 1.0};  // the unit matrix as a block
  constexpr Lanes kUnit1 = {0.0, 1.0, 0.0, 0.0};
  for (int k = 0; k < w.last; ++k) {
    const double* q = w.jerk + 36 * k;
    const Lanes* x = w.x + 3 * k;
    KnotSums& first = w.knots[k];
    KnotSums& second = w.knots[k + 1];
    Lanes cost = {};
    for (int b = 0; b < 6; ++b) {
      Lanes g = {};
      for (int c = 0; c < 6; ++c) g += q[6 * b + c] * x[c];
      cost += g * x[b];
      (b < 3 ? first.cost[b] : second.cost[b - 3]) += g;
    }
    w.objective += 0.5 * sum(cost);
    for (int i = 0; i < 6; ++i) {
      const double a = q[6 * kRow[i] + kColumn[i]];
      const double b = q[6 * (kRow[i] + 3) + kColumn[i] + 3];
      first.block[i][0] += a * kUnit0;
      first.block[i][1] += a * kUnit1;
      second.block[i][0] += b * kUnit0;
      second.block[i][1] += b * kUnit1;
    }
    for (int i = 0; i < 9; ++i) {
      const double c = q[6 * (i / 3 + 3) + i % 3];
      w.pieces[k].block[i][0] = c * kUnit0;
      w.pieces[k].block[i][1] = c * kUnit1;
    }
  }
}

// dual_residual = largest component of grad f + G' z over that of grad f (at least 1);
// multiplier_residual = |G' z|_1, for the proof of infeasibility. The ends are affine in eta and
// count with its component.
void measure_dual_residual(SplineState& w) {
  Lanes residual = {}, size = all(1.0), multipliers = {};
  for (int k = 1; k < w.last; ++k) {
    for (int b = 0; b < 3; ++b) {
      const Lanes cost = w.knots[k].cost[b];
      const Lanes dual = w.knots[k].dual[b];
      residual = larger(residual, magnitude(cost + dual));
      size = larger(size, magnitude(cost));
      multipliers += magnitude(dual);
    }
  }
  double worst = largest(residual), scale = largest(size);
  w.multiplier_residual = sum(multipliers);
  if (w.scale) {
    double cost = w.time_weight, dual = w.dual_eta;
    for (int b = 0; b < 3; ++b) {
      cost += sum(w.knots[0].cost[b] * w.start_rate[b]);
      cost += sum(w.knots[w.last].cost[b] * w.goal_rate[b]);
      dual += sum(w.knots[0].dual[b] * w.start_rate[b]);
      dual += sum(w.knots[w.last].dual[b] * w.goal_rate[b]);
    }
    worst = larger(worst, larger(cost + dual, -cost - dual));
    scale = larger(scale, larger(cost, -cost));
    w.multiplier_residual += larger(dual, -dual);
  }
  w.dual_residual = worst / scale;
}

// Takes the step that apply() has left, and sums everything that the Newton system is made of at
// the new point: residuals, gradients, the reduced Hessian.
void linearise(SplineState& w) {
  w.dual_eta = w.pull_eta = w.hessian_eta = 0.0;
  w.gap = w.proof = w.primal_residual = w.face_violation = w.limit_violation = 0.0;
  start_sums(w);
  linearise_faces(w);
  linearise_limits<false>(w, w.velocity);
  linearise_limits<true>(w, w.acceleration);
  if (w.jerk_limit.lanes != nullptr) linearise_limits<true>(w, w.jerk_limit);
  w.step = 0.0;
  measure_dual_residual(w);
}

// x = argmin of 1/2 x' Q x + pull / 2 sum of |p_k - guess_k|^2, ends and eta given: one Newton step.
bool smooth(SplineState& w, double pull) {
  w.pull_eta = 0.0;
  w.hessian_eta = 1.0;
  start_sums(w);
  for (int k = 0; k <= w.last; ++k) {
    w.knots[k].block[0][0] += Lanes{pull, 0.0, 0.0, pull};
    w.knots[k].block[0][1] += Lanes{0.0, pull, 0.0, 0.0};
  }
  if (!factor(w)) return false;
  load_rhs(w);
  solve(w);
  for (int i = 0; i < 3 * (w.last + 1); ++i) w.x[i] += w.dx[i];
  return true;
}

// r = g + 1 of every row, and how far limits are exceeded.
void evaluate(SplineState& w) {
  w.limit_violation = 0.0;
  start_sums(w);
  evaluate_faces(w);
  evaluate_limits<false>(w, w.velocity);
  evaluate_limits<true>(w, w.acceleration);
  if (w.jerk_limit.lanes != nullptr) evaluate_limits<true>(w, w.jerk_limit);
}

// The step with t = 0. reach = the share of it up to the first s or z that becomes zero, at most 1;
// product = ds' dz.
double predict(SplineState& w) {
  load_rhs(w);
  solve(w);
  w.product = 0.0;
  double worst = larger(1e-300, predict_faces(w));
  worst = larger(worst, predict_limits<false>(w, w.velocity));
  worst = larger(worst, predict_limits<true>(w, w.acceleration));
  if (w.jerk_limit.lanes != nullptr) worst = larger(worst, predict_limits<true>(w, w.jerk_limit));
  w.reach = worst > 1.0 ? 1.0 / worst : 1.0;
  // A predictor that ends at once says nothing about the second order: correcting for it can cycle.
  constexpr double kShort = 0.1;
  w.trust = w.reach < kShort ? 0.0 : 1.0;
  return w.reach;
}

// The step with t = (mu - trust ds dz) / s. @return the share of it up to the boundary
double correct(SplineState& w, double mu) {
  for (int k = 0; k <= w.last; ++k) {
    for (int b = 0; b < 3; ++b) w.knots[k].pull[b] = Lanes{};
  }
  w.pull_eta = 0.0;
  pull_faces(w, mu);
  pull_limits<false>(w, w.velocity, mu);
  pull_limits<true>(w, w.acceleration, mu);
  if (w.jerk_limit.lanes != nullptr) pull_limits<true>(w, w.jerk_limit, mu);
  load_rhs(w);
  solve(w);
  double worst = larger(1e-300, finish_faces(w));
  worst = larger(worst, finish_limits<false>(w, w.velocity));
  worst = larger(worst, finish_limits<true>(w, w.acceleration));
  if (w.jerk_limit.lanes != nullptr) worst = larger(worst, finish_limits<true>(w, w.jerk_limit));
  return 1.0 / worst;
}

void apply(SplineState& w, double step) {
  for (int i = 0; i < 3 * (w.last + 1); ++i) w.x[i] += step * w.dx[i];
  w.eta += step * w.deta;
  w.step = step;
}
