#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "goshawk/movers/mover.hpp"
#include "goshawk/obstacle_tracker/obstacle_tracker.hpp"

namespace goshawk::obstacle_tracker {

/// [s] ahead at which bounds are judged
inline constexpr std::array<double, 4> kHorizons_s{0.0, 0.5, 1.0, 1.5};

/// How a tracker compares with the truth. Shares are NaN if there is nothing to count.
struct Figures {
  double recall = 0.0;          // share of the visible moving things that were told
  double precision = 0.0;       // share of what was told that is a thing
  std::int64_t false_told = 0;  // what was told and is none
  std::int64_t told = 0;
  std::int64_t switches = 0;      // times that a thing's id changed
  double position_error_m = 0.0;  // mean
  double position_p95_m = 0.0;
  double velocity_error_m_s = 0.0;  // mean
  double velocity_p95_m_s = 0.0;
  std::vector<double> delays_s{};  // from the begin of motion to the first time that it was told
  int never_told = 0;              // motions that ended before
  std::array<double, kHorizons_s.size()> in_bound{};  // share of the time, by horizon
};

/// Compares what a tracker tells with the movers that are there.
class Score {
 public:
  /// @param points_needed a thing that fewer points of a scan lie on cannot be seen
  explicit Score(std::vector<movers::Mover> truth, int points_needed = 4);

  /// @param points_map of the scan @param time_s of the obstacles, on the movers' clock
  void add(std::span<const Vec3> points_map, std::span<const TrackedObstacle> told, double time_s);

  Figures figures() const;

 private:
  struct Thing {
    bool moves = false;
    double moves_since_s = 0.0;
    bool waits = false;  // moves, and was not told since
    std::uint64_t id = 0;
  };

  int points_on(std::size_t mover, std::span<const Vec3> points_map, double time_s) const;
  void follow_motion(std::size_t mover, double time_s);
  void compare(std::size_t mover, const TrackedObstacle& o, double time_s);

  std::vector<movers::Mover> truth_;
  int points_needed_;
  std::vector<Thing> things_;
  std::int64_t visible_ = 0, found_ = 0, told_ = 0, false_ = 0, switches_ = 0;
  int never_told_ = 0;
  std::vector<double> position_m_, velocity_m_s_, delays_s_;
  std::array<std::int64_t, kHorizons_s.size()> inside_{};
  std::int64_t bounds_ = 0;
};

}  // namespace goshawk::obstacle_tracker
