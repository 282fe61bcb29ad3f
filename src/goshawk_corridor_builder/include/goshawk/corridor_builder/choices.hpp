#pragma once

#include "goshawk/core/words.hpp"

namespace goshawk::corridor_builder {

/// How polytopes are made.
enum class Generator {
  ellipsoid,  // expansion of an ellipsoid: the largest
  box,        // axis-aligned boxes: the cheapest
};

/// How the vehicle's size is kept out of obstacles.
enum class Margin {
  grown_grid,  // planes before the grown voxels
  sphere,      // planes that a ball touches before the voxels as they are; ellipsoid only
};

constexpr auto words_of(Generator) {
  using enum Generator;
  return std::to_array<Named<Generator>>({{ellipsoid, "ellipsoid"}, {box, "box"}});
}

constexpr auto words_of(Margin) {
  using enum Margin;
  return std::to_array<Named<Margin>>({{grown_grid, "grown_grid"}, {sphere, "sphere"}});
}

}  // namespace goshawk::corridor_builder
