#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/core/vector.hpp"

namespace goshawk::obstacle_tracker {

/// What was measured of each cell around the vehicle: free, and since when hit. A cell that was
/// seen free and is hit now holds something that came; one that is hit for long, what stands.
///
/// The window follows the vehicle: cells are addressed modulo its size, and those that enter are
/// cleared. Memory: 28 bytes a cell; 44 MB with the default configuration.
class EvidenceGrid {
 public:
  struct Parameters {
    double cell_m = 0.25;
    double range_m = 22.0;   // half of the window, horizontally
    double height_m = 12.0;  // of the window
    double settle_s = 3.0;
    double memory_s = 60.0;
  };

  explicit EvidenceGrid(const Parameters& parameters);
  /// How many cells a grid has with these parameters.
  static double cell_count(const Parameters& parameters);

  /// Begins a scan. @param center_map [m] of the window @param time_ms never below that before
  void begin(const Vec3& center_map, std::int32_t time_ms);
  /// Something is here. All hits of a scan come before its rays.
  void hit(const Vec3& p_map);
  /// Nothing is on the way from the sensor to a point, except in the last two cells. A cell that
  /// was hit in this scan stays so; one that was hit before is free after two scans without a hit.
  void pass(const Vec3& from_map, const Vec3& to_map);

  bool contains(const Vec3& p_map) const { return inside(cell_of(p_map)); }
  /// It is hit for settle_s or more.
  bool stands(const Vec3& p_map) const { return inside(cell_of(p_map)) && stands(cell_of(p_map)); }
  /// It, or a cell that touches it, stands: noise carries points of a surface into the next cell.
  bool is_beside_standing(const Vec3& p_map) const;
  /// It is not hit, and was seen free since then.
  bool is_free_since(const Vec3& p_map, std::int32_t time_ms) const;
  /// It was seen free, and is hit for less than settle_s.
  bool is_new(const Vec3& p_map) const;
  /// And it was free for a while, as was the space around it: so it is not the rim of something
  /// that some rays hit and others pass.
  bool stands_free(const Vec3& p_map) const;

  Index3 cell_of(const Vec3& p_map) const;

 private:
  static constexpr std::int32_t kNever = -1;
  struct Cell {
    std::int32_t first_ms = kNever;   // when it began to be hit; kNever: it is not
    std::int32_t hit_ms = kNever;     // last
    std::int32_t free_ms = kNever;    // last
    std::int32_t passed_ms = kNever;  // last scan whose rays passed
    std::int32_t ended_ms = kNever;   // when it was last found free again
    std::int32_t misses = 0;          // scans in a row that passed and did not hit
    bool restless = false;            // it was hit again soon after: the rim of something
  };

  bool inside(Index3 i) const;
  bool stands(Index3 inside) const {
    const Cell& cell = cells_[address(inside)];
    return cell.first_ms != kNever && now_ms_ - cell.first_ms >= settle_ms_;
  }
  std::size_t address(Index3 i) const;
  bool was_free(const Cell& cell) const {
    return cell.free_ms != kNever && now_ms_ - cell.free_ms <= memory_ms_;
  }
  void mark_free(Cell& cell);
  void clear_entering(Index3 lower);

  double cells_per_m_;
  std::int32_t settle_ms_, memory_ms_;
  double range_m_;
  Index3 size_, lower_;
  std::int32_t now_ms_ = 0;
  bool begun_ = false;
  std::vector<Cell> cells_;
};

}  // namespace goshawk::obstacle_tracker
