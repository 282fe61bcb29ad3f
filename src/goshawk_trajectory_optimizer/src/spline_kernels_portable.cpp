#include "spline_state.hpp"

namespace goshawk::trajectory_optimizer {
namespace {
#include "spline_kernels.inl"
}  // namespace

#ifdef GOSHAWK_HAS_AVX2_KERNELS
const SplineKernels& spline_kernels_avx2();
#endif

const SplineKernels& spline_kernels() {
  static constexpr SplineKernels kPortable{smooth,  evaluate, linearise, factor,
                                           predict, correct,  apply};
#ifdef GOSHAWK_HAS_AVX2_KERNELS
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  if (wide) return spline_kernels_avx2();
#endif
  return kPortable;
}

}  // namespace goshawk::trajectory_optimizer
