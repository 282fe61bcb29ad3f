#pragma once

#include <string>
#include <vector>

namespace goshawk::introspection {

/// `goshawk doctor [--json] [--timeout S]`: looks at the machine, the settings and the domain.
/// @return exit status: 0; 1 where something stands in the way; 2 for a wrong call
int doctor_command(std::vector<std::string> arguments);

}  // namespace goshawk::introspection
