#include "active_set_state.hpp"

namespace goshawk::trajectory_optimizer {
namespace {
#include "active_set_kernels.inl"
}  // namespace

#ifdef GOSHAWK_HAS_AVX2_KERNELS
const ActiveSetKernels& active_set_kernels_avx2();
#endif

const ActiveSetKernels& active_set_kernels() {
  static constexpr ActiveSetKernels kPortable{factor, weigh,  place, price,  reach,   project,
                                              turn,   append, drop,  refine, measure, polish};
#ifdef GOSHAWK_HAS_AVX2_KERNELS
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  if (wide) return active_set_kernels_avx2();
#endif
  return kPortable;
}

}  // namespace goshawk::trajectory_optimizer
