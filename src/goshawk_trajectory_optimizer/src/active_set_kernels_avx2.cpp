// Compiled with -mavx2, called if the processor has it.
#include "active_set_state.hpp"

namespace goshawk::trajectory_optimizer {
namespace {
#include "active_set_kernels.inl"
}  // namespace

const ActiveSetKernels& active_set_kernels_avx2();
const ActiveSetKernels& active_set_kernels_avx2() {
  static constexpr ActiveSetKernels kAvx2{factor, weigh,  place, price,  reach,   project,
                                          turn,   append, drop,  refine, measure, polish};
  return kAvx2;
}

}  // namespace goshawk::trajectory_optimizer
