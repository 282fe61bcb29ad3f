#pragma once

#include <functional>

#include "goshawk/core/random.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::worlds {

/// Solid voxels to add: `voxels` placed with its voxel (0, 0, 0) at `lower` of the world. Parts
/// that stick out of the world are cut off.
struct Shape {
  Index3 lower;
  BitGrid voxels;
};

Shape solid_box(Index3 lower, Index3 size);

/// A world in the making, together with its growth, so that the blocked share is known after
/// every step. Growth distributes over union: grow(A or B) = grow(A) or grow(B), so only the
/// neighbourhood of a new shape is looked at.
class Builder {
 public:
  Builder(const WorldSpec& spec, const GridGeometry& geometry);

  /// @return blocked share of the grown map
  double share() const { return double(blocked_) / double(occupied_.voxels()); }

  /// Adds the shape unless its growth would block a protected voxel, would lift share() above
  /// max_share, or adds nothing. @return whether it was added
  bool try_add(const Shape& shape, double max_share);

  /// Sets voxels without a look at anything; refresh() afterwards.
  void put(const Shape& shape) { write(shape, true); }
  void carve(const Shape& shape) { write(shape, false); }
  /// No later try_add may block these voxels.
  void protect(const Shape& shape);

  /// Clears what would block a keep_free point, and grows everything anew.
  void refresh();

  const GridGeometry& geometry() const { return geometry_; }
  Index3 size() const { return geometry_.size; }
  /// @return ceil(length / resolution) voxels, at least 1
  int voxels_of(double length_m) const;
  BitGrid take_occupied() { return std::move(occupied_); }
  BitGrid& occupied() { return occupied_; }

 private:
  void write(const Shape& shape, bool value);

  GridGeometry geometry_;
  double inflation_m_;
  int reach_;          // [voxels] no growth goes further
  BitGrid occupied_;   // outside = true
  BitGrid grown_;      // outside = false
  BitGrid protected_;  // outside = false
  BitGrid keep_free_;  // outside = false
  std::int64_t blocked_ = 0;
};

/// Adds shapes from `draw` until `density` of the grown map is blocked. `draw` gets a scale in
/// (0, 1] that shrinks when shapes turn out too large for what is left.
/// @return invalid_parameter if the density is not reached
Status fill_to_density(Builder& builder, double density,
                       const std::function<Shape(double scale)>& draw);

Result<World> make_noise(const WorldSpec& spec, const GridGeometry& geometry);
Result<World> make_boxes(const WorldSpec& spec, const GridGeometry& geometry);
Result<World> make_forest(const WorldSpec& spec, const GridGeometry& geometry);
Result<World> make_office(const WorldSpec& spec, const GridGeometry& geometry);

}  // namespace goshawk::worlds
