#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "goshawk/core/moving_box.hpp"
#include "goshawk/obstacle_tracker/axis_filter.hpp"
#include "goshawk/obstacle_tracker/clusters.hpp"
#include "goshawk/obstacle_tracker/config.hpp"
#include "goshawk/obstacle_tracker/evidence_grid.hpp"

namespace goshawk::obstacle_tracker {

/// One scan, placed in the map.
struct Scan {
  std::int64_t stamp_ns = 0;
  std::span<const Vec3> points_map;               // [m]
  std::span<const Vec3> origins_map;              // [m] of the sensor: one, or one a point
  std::span<const std::int64_t> offsets_ns = {};  // of each point after the stamp; or empty
};

/// What moves, as tracked, and how wrong it may be.
struct TrackedObstacle {
  MovingBox box;                // now, with one standard deviation of position and velocity
  double bound_m = 0.0;         // its true centre is within bound_m + bound_rate_m_s t of
  double bound_rate_m_s = 0.0;  // the box's, carried on at its velocity for t seconds,
  double horizon_s = 0.0;       // up to here
  double top_speed_m_s = 0.0;   // afterwards
};

/// From live clouds to tracked obstacles. What moves is told from what stands by evidence over
/// time: points in cells that were seen free (EvidenceGrid), grouped (Clusters), followed from scan
/// to scan (AxisFilter), and told once they have moved farther than noise explains.
///
/// The same scans give the same answers.
class ObstacleTracker {
 public:
  /// @return invalid_parameter with every fault, or for a grid of more than 32 million cells
  static Result<ObstacleTracker> create(const Config& config);

  /// @return invalid_input for a scan whose lists disagree, or that is not newer than the one
  /// before: it changes nothing. A scan that is more than 2 s newer starts anew: what was known of
  /// free space is kept, tracks are not.
  Status add(const Scan& scan);

  /// Forgets all, as after a jump of the map's frame.
  void reset();

  /// What moved at the last scan. Valid until the next call of add() or reset().
  std::span<const TrackedObstacle> obstacles() const { return obstacles_; }
  /// [ns] the moment at which they are so: the last scan's newest point
  std::int64_t time_ns() const { return time_ns_; }

 private:
  struct Track {
    std::uint64_t id = 0;  // 0: not told yet
    std::array<AxisFilter, 3> axes;
    Vec3 half_m = Vec3::Zero();
    Vec3 birth_map = Vec3::Zero(), rest_map = Vec3::Zero();
    double time_s = 0.0, seen_s = 0.0;   // of the filter, of the last cluster
    double birth_s = 0.0, rest_s = 0.0;  // first cluster, begin of rest
    int hits = 1;
    std::int64_t points = 0, standing_free = 0;  // of all its clusters
    bool taken = false;                          // in this scan

    Vec3 position() const { return {axes[0].position, axes[1].position, axes[2].position}; }
    Vec3 velocity() const { return {axes[0].velocity, axes[1].velocity, axes[2].velocity}; }
    bool told() const { return id != 0; }
  };
  struct Match {
    double cost;
    std::size_t track, cluster;
  };

  explicit ObstacleTracker(const Config& config);

  Status check(const Scan& scan) const;
  void read(const Scan& scan);
  bool is_of_track(const Vec3& p_map, double t_s) const;
  void reach_down(Cluster& cluster) const;
  void associate(const Vec3& origin_map);
  Vec3 center_of(const Cluster& cluster, const Vec3& half, const Vec3& origin_map) const;
  Vec3 half_of(const Cluster& cluster) const;
  std::optional<double> cost(const Track& track, const Cluster& cluster,
                             const Vec3& origin_map) const;
  void update(Track& track, const Cluster& cluster, const Vec3& origin_map);
  void begin(const Cluster& cluster, const Vec3& origin_map);
  void judge(Track& track);
  void forget(double now_s);
  void tell(double now_s);

  Config config_;
  EvidenceGrid grid_;
  Clusters clusters_;
  std::vector<MovingPoint> points_;
  std::vector<char> of_track_;  // for each point of the scan
  std::span<Cluster> found_;
  std::vector<Track> tracks_;
  std::vector<Match> matches_;
  std::vector<char> cluster_taken_;
  std::vector<TrackedObstacle> obstacles_;
  std::uint64_t next_id_ = 1;
  std::optional<std::int64_t> first_ns_;
  std::int64_t stamp_ns_ = 0, time_ns_ = 0;
};

}  // namespace goshawk::obstacle_tracker
