#pragma once

#include <string>

#include "goshawk/core/bit_grid.hpp"

namespace goshawk::flight_report {

/// A grid as text: lengths of clear and set runs in turn, x fastest, then y, then z, beginning with
/// clear; LEB128, then base64. Maps are mostly runs.
std::string runs_of(const BitGrid& grid);

}  // namespace goshawk::flight_report
