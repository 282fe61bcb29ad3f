#pragma once

#include <optional>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/grid_update.hpp"

namespace goshawk::flight_report {

/// A map at one moment of a flight.
struct MapMoment {
  double t_s = 0.0;             // [s] on the flight's clock
  VoxelGrid grid;               // the window, known and grown
  std::vector<Vec3> track_map;  // [m] where the vehicle has been so far
};

/// The maps of a flight, at a limited number of moments. Grids share what did not change.
class MapTimeline {
 public:
  /// @param step_s [s] least time between moments; it doubles whenever `most` are kept
  /// @param most moments, at least 2
  explicit MapTimeline(double step_s = 0.2, std::size_t most = 200)
      : step_s_(step_s), most_(most) {}

  /// The whole map. The newest version again is left out. @param t_s when it was so
  void take(double t_s, VoxelGrid grid);
  /// What changed. One that does not follow the newest map is left out: the whole map comes soon
  /// after. @return invalid_input if it follows, but cannot be applied
  Status take(double t_s, const GridUpdate& update);

  const std::optional<VoxelGrid>& newest() const { return newest_; }
  /// Oldest first; the last is the newest map. Without tracks.
  std::vector<MapMoment> moments() const;

 private:
  void keep(double t_s);

  double step_s_;
  std::size_t most_;
  double newest_t_s_ = 0.0;
  std::optional<VoxelGrid> newest_ = {};
  std::vector<MapMoment> kept_ = {};
};

/// So many of the moments: the first, the last, and others evenly between. @param count at least 1;
/// 1: the last
std::vector<MapMoment> spread(const std::vector<MapMoment>& moments, std::size_t count);

}  // namespace goshawk::flight_report
