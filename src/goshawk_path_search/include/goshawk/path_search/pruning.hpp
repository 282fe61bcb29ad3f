#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/core/vector.hpp"
#include "goshawk/path_search/choices.hpp"

namespace goshawk::path_search {

/// Drops nodes of a voxel path by exact line of sight (goshawk::line_is_free). Works on the real
/// points, so that the ends stay where they are. A segment between neighbours of the path is taken
/// without a test: under no-squeeze it is free anyhow, under squeeze it may touch an obstacle edge
/// and there is no other way. Every other segment is free.
///
/// The object holds memory that is reused; one object is for one thread.
class PathPruner {
 public:
  /// @param nodes [voxel units, GridGeometry::to_grid] a path, consecutive nodes are connected
  /// @param kept overwritten: indices of the nodes that stay, ascending, with the first and the
  /// last one (one index for a path of one node, none for an empty one)
  void prune(Pruning pruning, const BitGrid& blocked, std::span<const Vec3> nodes,
             std::vector<int>& kept);

 private:
  struct Candidate {
    double length;
    int from;
  };

  bool visible(int from, int to);
  double length(const std::vector<int>& indices) const;
  void greedy(std::vector<int>& kept);
  void greedy_by_halving(bool forward, std::vector<int>& kept);
  void shortest(std::vector<int>& kept);
  void choose_candidates(const std::vector<int>& always);
  bool relax(std::size_t to, double bound);

  const BitGrid* blocked_ = nullptr;
  std::span<const Vec3> nodes_;
  double work_left_ = 0.0;       // [voxels] how much more line of sight may be tested
  std::vector<int> other_;       // the greedy polyline from the other end
  std::vector<int> candidates_;  // nodes that the shortest polyline may use
  std::vector<double> reached_;  // length of the shortest polyline to each candidate
  std::vector<int> before_;      // the candidate before it
  std::vector<Candidate> heap_;
};

}  // namespace goshawk::path_search
