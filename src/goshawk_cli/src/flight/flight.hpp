#pragma once

#include <functional>
#include <string>

#include "flight/preparation.hpp"
#include "json.hpp"

namespace goshawk::cli {

using Say = std::function<void(const std::string& sentence)>;

/// A whole flight: starts every stage, sends the goals, has the track judged, writes the folder.
/// Ctrl-C ends it in order. @param say hears how it goes
/// @return the content of flight.json (docs/cli.md), also if a goal was not reached; a failure, and
/// no folder, if the stages could not be started: invalid_parameter if a launch file or a parameter
/// is wrong
Result<Json> fly(const FlyOptions& options, const Preparation& preparation, const Say& say);

}  // namespace goshawk::cli
