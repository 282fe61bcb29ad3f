#pragma once

// Four doubles at a time, for the kernels only. Each operation is one of IEEE 754 on each lane, so
// that the bits are the same whatever instructions they compile to.

#define GOSHAWK_INLINE inline __attribute__((always_inline))

namespace goshawk::trajectory_optimizer {

// The alignment is stated: without it, it would depend on the instruction set.
using Lanes = double __attribute__((vector_size(32), aligned(32)));

/// Four faces n . y <= offset. One that only fills up the four has no normal and an offset of 1.
struct FourFaces {
  Lanes nx, ny, nz, offset;
};

namespace {

using LaneIndices = long long __attribute__((vector_size(32)));

GOSHAWK_INLINE Lanes all(double v) {
  return Lanes{v, v, v, v};
}
GOSHAWK_INLINE Lanes larger(Lanes a, Lanes b) {
  return a > b ? a : b;
}
GOSHAWK_INLINE double larger(double a, double b) {
  return a > b ? a : b;
}
GOSHAWK_INLINE Lanes magnitude(Lanes a) {
  return larger(a, -a);
}
GOSHAWK_INLINE double sum(Lanes a) {
  return (a[0] + a[1]) + (a[2] + a[3]);
}
GOSHAWK_INLINE double largest(Lanes a) {
  return larger(larger(a[0], a[1]), larger(a[2], a[3]));
}

/// The four vectors become the four columns of what they were the rows of.
GOSHAWK_INLINE void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes ab_even = __builtin_shuffle(a, b, LaneIndices{0, 4, 2, 6});
  const Lanes ab_odd = __builtin_shuffle(a, b, LaneIndices{1, 5, 3, 7});
  const Lanes cd_even = __builtin_shuffle(c, d, LaneIndices{0, 4, 2, 6});
  const Lanes cd_odd = __builtin_shuffle(c, d, LaneIndices{1, 5, 3, 7});
  a = __builtin_shuffle(ab_even, cd_even, LaneIndices{0, 1, 4, 5});
  b = __builtin_shuffle(ab_odd, cd_odd, LaneIndices{0, 1, 4, 5});
  c = __builtin_shuffle(ab_even, cd_even, LaneIndices{2, 3, 6, 7});
  d = __builtin_shuffle(ab_odd, cd_odd, LaneIndices{2, 3, 6, 7});
}

/// @return the sums of the four vectors, one a lane
GOSHAWK_INLINE Lanes sums(Lanes a, Lanes b, Lanes c, Lanes d) {
  transpose(a, b, c, d);
  return (a + b) + (c + d);
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
