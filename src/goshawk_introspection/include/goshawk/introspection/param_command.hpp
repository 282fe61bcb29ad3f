#pragma once

#include <string>
#include <vector>

namespace goshawk::introspection {

/// `goshawk param describe COMPONENT [--json]`: its parameters with type, unit, default, range and
/// meaning, from the installed component itself; none needs to run.
/// @return exit status: 0; 2 for a wrong call (the sentence names the nearest component)
int param_command(std::vector<std::string> arguments);

}  // namespace goshawk::introspection
