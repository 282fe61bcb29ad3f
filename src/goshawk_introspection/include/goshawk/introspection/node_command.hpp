#pragma once

#include <string>
#include <vector>

namespace goshawk::introspection {

/// `goshawk node list [--json] [--timeout S]`: the nodes of the domain.
/// @return exit status: 0; 1 where there is none; 2 for a wrong call
int node_command(std::vector<std::string> arguments);

}  // namespace goshawk::introspection
