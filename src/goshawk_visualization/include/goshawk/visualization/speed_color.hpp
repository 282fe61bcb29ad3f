#pragma once

#include "goshawk/core/vector.hpp"

namespace goshawk::visualization {

/// Blue over purple to orange: bluer to yellower all the way, which every kind of colour vision
/// tells apart. Pictures, markers and the flight's page (page/theme.js) share these colours.
/// @param ratio speed over the limit; beyond [0, 1] it is clamped
/// @return red, green and blue, each from 0 to 1
Vec3 speed_color(double ratio);

}  // namespace goshawk::visualization
