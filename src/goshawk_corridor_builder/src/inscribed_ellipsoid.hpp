#pragma once

#include <span>

#include "ellipsoid.hpp"
#include "separating_plane.hpp"

namespace goshawk::corridor_builder {

/// A large ellipsoid inside planes, on the way to the largest: maximise log det L subject to
/// |L' n| + n . c <= d for every plane (Boyd and Vandenberghe, Convex Optimization, section 8.4.2),
/// by a few damped Newton steps on the barrier of these second-order cones in the nine unknowns
/// (c, L). They stop short of the optimum on purpose: see kLastWeight.
///
/// @param inside an ellipsoid inside the planes; shrunk by halves until it truly is
/// @return false if not even a small part of it is (its centre lies on or behind a plane)
bool grow_inscribed_ellipsoid(std::span<const Plane> planes, const Ellipsoid& inside,
                              Ellipsoid& grown);

}  // namespace goshawk::corridor_builder
