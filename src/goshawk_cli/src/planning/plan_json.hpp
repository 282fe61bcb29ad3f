#pragma once

#include "cli.hpp"
#include "planning/planning.hpp"

namespace goshawk::cli {

/// The object that `plan --json` prints; docs/cli.md lists its keys. What a plan did not come to
/// is null.
Json plan_to_json(const Plan& plan);
Json certificate_to_json(const Certificate& c);

}  // namespace goshawk::cli
