#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "goshawk/core/error.hpp"

namespace goshawk::bench {

using Call = nlohmann::json;

/// main() of a bench program. `goshawk bench NAME` parses the command line (goshawk_cli) and hands
/// all options over as one JSON object, the only argument.
/// @param run what is done with the options. @return its exit status; 1 with a failure on standard
/// output (JSON) or standard error if it throws
int bench_call(int argc, char** argv, const std::string& name,
               const std::function<int(const Call&)>& run);

/// A failure as every verb of goshawk tells it. @return exit status 1
int report_failure(const std::string& name, bool json, const Error& error);

}  // namespace goshawk::bench
