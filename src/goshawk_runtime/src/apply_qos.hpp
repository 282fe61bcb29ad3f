#pragma once

#include <fastdds/dds/core/policy/QosPolicies.hpp>

#include "context_impl.hpp"
#include "goshawk/runtime/qos.hpp"

namespace goshawk::runtime {

template <typename EndpointQos>
void apply(const Qos& qos, EndpointQos& out) {
  out.reliability().kind =
      qos.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  out.durability().kind =
      qos.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  out.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  out.history().depth = qos.depth;
  out.resource_limits().max_samples = 0;  // only the depth limits
  out.resource_limits().max_samples_per_instance = qos.depth;
  // Buffers as large as a message needs, reused: a latched map must not be stored twice.
  out.endpoint().history_memory_policy =
      rtps::MemoryManagementPolicy_t::DYNAMIC_REUSABLE_MEMORY_MODE;
}

/// How a writer sends: in the caller's thread, and what a late reader missed at once.
inline void apply_writer_times(dds::DataWriterQos& out) {
  out.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  // Fast DDS' 3 s would let a late reader of a latched topic wait that long for what it missed.
  out.reliable_writer_qos().times.heartbeatPeriod = {0, 100'000'000};
}

}  // namespace goshawk::runtime
