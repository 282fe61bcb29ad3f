#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/tracker/config.hpp"

namespace goshawk::tracker {

/// A committed trajectory as it came.
struct Commit {
  CommittedTrajectory trajectory;
  std::int64_t start_ns = 0;  // when it begins, on the tracker's clock
  std::int64_t came_ns = 0;
  std::int64_t wire_ns = 0;  // how long it travelled
};

/// Holds the newest commit back until what decides about it is there: odometry, the map version
/// that it names, and the second opinion if that is required; each for its bound. Time is an
/// argument, on one clock [ns].
///
///     if (auto old = gate.put(std::move(commit))) report(cancelled, *old);
///     if (auto release = gate.release(has_odometry, map_version, now_ns)) {
///       release->verdict ? tracker.accept(...) : report(release->verdict)
///     }
class CommitGate {
 public:
  /// @pre check(config) ok
  explicit CommitGate(const Config& config)
      : require_map_(config.require_map),
        map_wait_s_(config.map_wait_s),
        second_opinion_(config.second_opinion),
        second_opinion_wait_s_(config.second_opinion_wait_s) {}

  /// @return the commit that waited until now, and gives way
  std::optional<std::uint64_t> put(Commit commit);

  /// What flight_check says of a trajectory; may come before the trajectory does. One that was
  /// found touching (collision) stays so, whatever is said of it later.
  void hear(std::uint64_t id, const Error& outcome);

  bool waits() const { return waiting_.has_value(); }

  struct Release {
    Commit commit;
    Status verdict;  // collision: found touching; stage_silent, or the checker's own code: not judged
  };
  /// @param map_version of the newest map; nothing: none has come
  /// @return the commit whose time has come: once
  std::optional<Release> release(bool has_odometry, std::optional<std::uint64_t> map_version,
                                 std::int64_t now_ns);

 private:
  struct Opinion {
    std::uint64_t id = 0;  // 0: none
    Error outcome;
  };
  bool waits_for_map(std::optional<std::uint64_t> map_version) const;
  const Opinion* opinion() const;
  Status verdict() const;

  bool require_map_;
  double map_wait_s_;
  SecondOpinion second_opinion_;
  double second_opinion_wait_s_;
  std::optional<Commit> waiting_;
  std::array<Opinion, 16> opinions_;  // the newest, one a trajectory
  std::size_t next_opinion_ = 0;
};

}  // namespace goshawk::tracker
