#pragma once

#include "json.hpp"
#include "planning/planning.hpp"

namespace goshawk::cli {

/// The object that `plan --json` prints; docs/cli.md lists its keys. Parts that the plan did not
/// reach are null.
Json plan_to_json(const Plan& plan);
Json certificate_to_json(const Certificate& c);

}  // namespace goshawk::cli
