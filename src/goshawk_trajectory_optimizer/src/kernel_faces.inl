// The faces of the polytopes: linear rows g = n . y - offset on a point y of one knot, four faces a
// vector. Gradient n times the point's map (1, beta, gamma); no Hessian of their own.

// y = p + beta v + gamma a
GOSHAWK_INLINE Lanes point_of(const Lanes* knot, const double* map) {
  return map[0] * knot[0] + map[1] * knot[1] + map[2] * knot[2];
}

// Sums over the faces of a point, by components of y: g = sum z n, pull = sum z / s r n, and
// w = sum z / s n n' as xx xy xz yy yz zz. Four partial sums each, to be added up.
struct FaceSums {
  Lanes g[3] = {}, pull[3] = {}, w[6] = {};
};

// r, 1 / s and the face's part of the sums.
GOSHAWK_INLINE void linearise_face(Row& f, const FourFaces& n, const Lanes* y, FaceSums& to,
                                   Lanes& gap, Lanes& proof, Lanes& worst, Lanes& outside) {
  f.residual = n.nx * y[0] + n.ny * y[1] + n.nz * y[2] - n.offset + f.s;
  f.inverse_s = 1.0 / f.s;
  const Lanes weight = f.z * f.inverse_s;
  gap += f.s * f.z;
  proof += f.z * f.residual;
  worst = larger(worst, magnitude(f.residual));
  outside = larger(outside, f.residual - f.s);
  const Lanes pull = weight * f.residual;
  const Lanes wx = weight * n.nx, wy = weight * n.ny, wz = weight * n.nz;
  to.g[0] += f.z * n.nx;
  to.g[1] += f.z * n.ny;
  to.g[2] += f.z * n.nz;
  to.pull[0] += pull * n.nx;
  to.pull[1] += pull * n.ny;
  to.pull[2] += pull * n.nz;
  to.w[0] += wx * n.nx;
  to.w[1] += wx * n.ny;
  to.w[2] += wx * n.nz;
  to.w[3] += wy * n.ny;
  to.w[4] += wy * n.nz;
  to.w[5] += wz * n.nz;
}

// The Hessian of a knot += (m m') (x) W: block (r, c) += m_r m_c W, for m = (1, beta, gamma), W a
// symmetric 3 x 3 matrix over the axes
GOSHAWK_INLINE void add_diagonal(KnotSums& knot, const double* m, Lanes w0, Lanes w1) {
  int block = 0;
  constexpr int kRow[6] = {0, 1, 2, 1, 2, 2};
  constexpr int kColumn[6] = {0, 0, 0, 1, 1, 2};
  for (; block < 6; ++block) {
    const double c = m[kRow[block]] * m[kColumn[block]];
    knot.block[block][0] += c * w0;
    knot.block[block][1] += c * w1;
  }
}

// All faces: residuals, G' z, G' (z / s) r and G' diag(z / s) G.
void linearise_faces(SplineState& w) {
  Lanes gap = {}, proof = {}, worst = {}, outside = {};
  const Lanes zero = {};
  for (int p = 0; p < w.face_points; ++p) {
    const FaceRange& range = w.ranges[p];
    const Lanes point = point_of(w.x + 3 * range.knot, range.map);
    const Lanes y[3] = {all(point[0]), all(point[1]), all(point[2])};
    FaceSums to;
    const FourFaces* n = w.planes + range.planes;
    for (int i = range.begin; i < range.end; ++i, ++n) {
      if (w.step != 0.0) take_step(w.faces[i], w.step);
      linearise_face(w.faces[i], *n, y, to, gap, proof, worst, outside);
    }
    KnotSums& knot = w.knots[range.knot];
    const Lanes g = sums(to.g[0], to.g[1], to.g[2], zero);
    const Lanes pull = sums(to.pull[0], to.pull[1], to.pull[2], zero);
    for (int b = 0; b < 3; ++b) {
      knot.dual[b] += range.map[b] * g;
      knot.pull[b] += range.map[b] * pull;
    }
    add_diagonal(knot, range.map, sums(to.w[0], to.w[1], to.w[2], to.w[3]),
                 sums(to.w[4], to.w[5], zero, zero));
  }
  w.gap += sum(gap);
  w.proof += sum(proof);
  w.primal_residual = larger(w.primal_residual, largest(worst));
  w.face_violation = largest(outside);
}

// r = n . y - offset + 1
void evaluate_faces(SplineState& w) {
  for (int p = 0; p < w.face_points; ++p) {
    const FaceRange& range = w.ranges[p];
    const Lanes point = point_of(w.x + 3 * range.knot, range.map);
    const FourFaces* n = w.planes + range.planes;
    for (int i = range.begin; i < range.end; ++i, ++n) {
      w.faces[i].residual =
          n->nx * point[0] + n->ny * point[1] + n->nz * point[2] - n->offset + 1.0;
    }
  }
}

// ds = -r - n . dy, dz = -z - z / s ds, target = ds dz.
// @return the largest of -ds / s and -dz / z
double predict_faces(SplineState& w) {
  Lanes worst = {}, product = {};
  for (int p = 0; p < w.face_points; ++p) {
    const FaceRange& range = w.ranges[p];
    const Lanes d = point_of(w.dx + 3 * range.knot, range.map);
    const Lanes dy[3] = {all(d[0]), all(d[1]), all(d[2])};
    const FourFaces* n = w.planes + range.planes;
    for (int i = range.begin; i < range.end; ++i, ++n) {
      Row& f = w.faces[i];
      const Lanes ds = -f.residual - (n->nx * dy[0] + n->ny * dy[1] + n->nz * dy[2]);
      const Lanes dz = -f.z - f.z * f.inverse_s * ds;
      const Lanes ratio = ds * f.inverse_s;  // dz / z = -1 - ds / s
      worst = larger(worst, larger(-ratio, 1.0 + ratio));
      f.target = ds * dz;
      product += f.target;
    }
  }
  w.product += sum(product);
  return largest(worst);
}

// target = t = (mu - trust ds dz) / s, and pull = G' (t + z / s r)
void pull_faces(SplineState& w, double mu) {
  const Lanes zero = {};
  for (int p = 0; p < w.face_points; ++p) {
    const FaceRange& range = w.ranges[p];
    Lanes pull[3] = {};
    const FourFaces* n = w.planes + range.planes;
    for (int i = range.begin; i < range.end; ++i, ++n) {
      Row& f = w.faces[i];
      f.target = (mu - w.trust * f.target) * f.inverse_s;
      const Lanes c = f.target + f.z * f.inverse_s * f.residual;
      pull[0] += c * n->nx;
      pull[1] += c * n->ny;
      pull[2] += c * n->nz;
    }
    const Lanes all_pull = sums(pull[0], pull[1], pull[2], zero);
    KnotSums& knot = w.knots[range.knot];
    for (int b = 0; b < 3; ++b) knot.pull[b] += range.map[b] * all_pull;
  }
}

// residual = ds = -r - n . dy. @return the largest of -ds / s and -dz / z
double finish_faces(SplineState& w) {
  Lanes worst = {};
  for (int p = 0; p < w.face_points; ++p) {
    const FaceRange& range = w.ranges[p];
    const Lanes d = point_of(w.dx + 3 * range.knot, range.map);
    const Lanes dy[3] = {all(d[0]), all(d[1]), all(d[2])};
    const FourFaces* n = w.planes + range.planes;
    for (int i = range.begin; i < range.end; ++i, ++n) {
      Row& f = w.faces[i];
      const Lanes ds = -f.residual - (n->nx * dy[0] + n->ny * dy[1] + n->nz * dy[2]);
      const Lanes dz = f.target - f.z - f.z * f.inverse_s * ds;
      worst = larger(worst, larger(-ds * f.inverse_s, -dz / f.z));
      f.residual = ds;
    }
  }
  return largest(worst);
}
