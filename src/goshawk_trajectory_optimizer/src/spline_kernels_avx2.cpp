// Compiled with -mavx2, called if the processor has it.
#include "spline_state.hpp"

namespace goshawk::trajectory_optimizer {
namespace {
#include "spline_kernels.inl"
}  // namespace

const SplineKernels& spline_kernels_avx2();
const SplineKernels& spline_kernels_avx2() {
  static constexpr SplineKernels kAvx2{smooth,  evaluate, linearise, factor,
                                       predict, correct,  apply};
  return kAvx2;
}

}  // namespace goshawk::trajectory_optimizer
