#pragma once

#include <atomic>
#include <cstdint>

namespace goshawk::faults {

/// What is wrong with one stage at the moment: the content of the file $GOSHAWK_FAULTS/STAGE, which
/// a campaign writes (scripts/fault_control.py) and the stage's shim reads. Zero: nothing is wrong.
struct Control {
  std::atomic<std::int64_t> wall_offset_ns;    // the stage's wall clock is ahead by this
  std::atomic<std::uint32_t> receive_loss_ppm;  // of the datagrams that come, so many are lost
  std::atomic<std::uint32_t> send_loss_ppm;     // of those that it sends
  std::atomic<std::uint64_t> seed;              // of which they are
  std::atomic<std::uint64_t> drawn;             // datagrams about which the shim has decided
  std::atomic<std::uint64_t> lost;              // of these
};
static_assert(sizeof(Control) == 40 && std::atomic<std::uint64_t>::is_always_lock_free);

/// This process' own, or nullptr if no campaign asked for faults.
Control* control();

}  // namespace goshawk::faults
