#pragma once

#include "flight/child_verb.hpp"
#include "goshawk/runtime/context.hpp"

namespace goshawk::cli {

/// `goshawk record` into folder/flight.mcap, in a process of its own: a slow disk must not delay
/// the flight.
Result<ChildVerb> start_recorder(const std::string& folder, int domain);

/// The recorder joins a topic once it has found its writer: earlier messages are not recorded.
/// @return whether this context sees the recorder read all that the planning stages write
bool hears_planning(const runtime::Context& context, pid_t recorder);

}  // namespace goshawk::cli
