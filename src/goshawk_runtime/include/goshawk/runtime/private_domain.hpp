#pragma once

#include "goshawk/core/result.hpp"

namespace goshawk::runtime {

/// A DDS domain from 20 to 99 for a flight, a test or a measurement: no other holder on this
/// machine has it, and no DDS program is in it. It is held until this process ends, however that
/// happens; processes of all users count, files of none.
/// @return io_failed if all are in use
Result<int> hold_private_domain();

/// The same for one domain. @return false if it is held or a DDS program is in it
bool hold_domain(int domain);

}  // namespace goshawk::runtime
