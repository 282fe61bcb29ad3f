#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "goshawk/core/vector.hpp"

namespace goshawk::obstacle_tracker {

/// A point of a cloud that may belong to something that moves.
struct MovingPoint {
  Vec3 p_map = Vec3::Zero();  // [m]
  double t_s = 0.0;           // when it was measured
  bool stands_free = false;   // @see EvidenceGrid::stands_free()
};

/// Points of one thing.
struct Cluster {
  Vec3 lower_map = Vec3::Zero(), upper_map = Vec3::Zero();  // [m] box around them
  double t_s = 0.0;                                         // mean of their times
  int points = 0;
  int standing_free = 0;  // points that do
};

/// Groups points by cells: two cells belong together if they touch, or lie above each other with a
/// gap of at most vertical_gap_m. Keeps its memory from call to call.
class Clusters {
 public:
  Clusters(double cell_m, double vertical_gap_m);

  /// @return valid until the next call
  std::span<Cluster> group(std::span<const MovingPoint> points);

 private:
  struct Entry {
    std::uint64_t key;  // of the cell
    std::uint32_t point;
  };
  std::size_t root(std::size_t cell);
  void join(std::size_t cell, std::uint64_t key);

  double cells_per_m_;
  int reach_z_;  // cells
  std::vector<Entry> entries_;
  std::vector<std::uint64_t> keys_;       // of the cells, sorted
  std::vector<std::size_t> parents_;      // of the cells
  std::vector<std::int32_t> cluster_of_;  // root
  std::vector<Cluster> clusters_;
};

}  // namespace goshawk::obstacle_tracker
