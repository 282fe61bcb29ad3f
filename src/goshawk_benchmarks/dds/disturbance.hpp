#pragma once

#include <string>

#include "common/report.hpp"

/// Setpoints at 200 Hz beside maps of 12.5 MB at 2 Hz, over nodes as the stages have them.
namespace goshawk::bench {

/// Adds rows: latency of the setpoints alone and beside the maps, for stages in processes of their
/// own, for two processes, and for one.
void measure_disturbance(Report& report, int domain);

/// The other side, in a process of its own, until it is stopped.
/// @param roles letters: s writes setpoints, m writes maps, n reads maps
/// @return exit status
int run_roles(const std::string& roles);

}  // namespace goshawk::bench
