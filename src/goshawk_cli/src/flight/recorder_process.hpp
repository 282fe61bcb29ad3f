#pragma once

#include "goshawk/runtime/context.hpp"
#include "flight/launch_process.hpp"

namespace goshawk::cli {

/// `goshawk record` into folder/flight.mcap, in a process of its own: a slow disk must not be felt
/// in flight.
Result<LaunchProcess> start_recorder(const std::string& folder, int domain);

/// The recorder joins a topic once it has found who writes it: before that, messages are lost to
/// it.
/// @return whether this context sees the recorder read all that the planning stages write
bool hears_planning(const runtime::Context& context, pid_t recorder);

}  // namespace goshawk::cli
