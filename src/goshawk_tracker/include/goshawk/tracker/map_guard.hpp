#pragma once

#include <memory>
#include <optional>

#include "goshawk/core/free_curve.hpp"

namespace goshawk::tracker {

/// The newest map, and what it says about what is to be flown. Allocates nothing but sentences.
class MapGuard {
 public:
  /// @param required without any map nothing may be flown
  /// @param fly_unknown as FreeSpace
  MapGuard(bool required, bool fly_unknown) : required_(required), space_(fly_unknown) {}

  /// @pre grid->check() ok
  void set_map(std::shared_ptr<const VoxelGrid> grid) { space_.set_map(std::move(grid)); }
  /// nullptr before the first.
  const VoxelGrid* grid() const { return space_.grid(); }
  /// What the newest map lets the vehicle fly through.
  const FreeSpace& space() const { return space_; }

  /// May it be flown from from_s on, [s] since its start? A newer map than the one that it was
  /// planned in decides alone.
  /// @return no_map: none has come, or not yet the version that it names; trajectory_blocked
  Status check(const CommittedTrajectory& committed, double from_s) const;

  /// When a curve first enters space that is not known to be free. A vehicle that is in such space
  /// already, by a tracking error beside a wall, is to leave it: its way out does not count.
  /// @return [s] since the curve's start; nothing: nowhere; 0 without a map
  std::optional<double> first_contact(const BezierPiece& curve) const;

 private:
  bool required_;
  FreeSpace space_;
};

}  // namespace goshawk::tracker
