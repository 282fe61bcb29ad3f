#pragma once

#include <string>

namespace goshawk::runtime {

/// Goshawk's version, as package.xml has it: "0.1.0". Every process tells it to its domain.
std::string version();

/// What the middleware was compiled against: "2.9.1".
std::string middleware_version();

}  // namespace goshawk::runtime
