#pragma once

#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::path_search {

/// Pulls a pruned path tight: inner points leave the voxel centres and move towards the chord of
/// their neighbours, or along a leg towards one of them, as far as both legs stay free
/// (goshawk::line_is_free); a point that its neighbours no longer need is dropped. Every step
/// shortens the polyline, so it is never longer than before. The ends stay.
///
/// The result touches the surfaces of obstacles: right for a length, but a corridor has less room
/// at such a bend.
/// @param points [voxel units, GridGeometry::to_grid] consecutive ones are connected. A leg that is
/// not free (under squeeze) stays as it is, unless a free one can take its place
/// @return how many points moved or were dropped
int pull_tight(const BitGrid& blocked, std::vector<Vec3>& points);

}  // namespace goshawk::path_search
