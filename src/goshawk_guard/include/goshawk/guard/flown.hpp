#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "goshawk/core/committed_trajectory.hpp"

namespace goshawk::guard {

/// What the tracker says of itself.
struct Tracking {
  enum class Mode { none, holds, follows, brakes };  // none: no odometry, or landing
  Mode mode = Mode::none;
  Vec3 reference_map = Vec3::Zero();  // [m] where the vehicle is to be now
};

/// What is flown now and what waits for its time, as far as the guard knows: its own commits, and
/// what the tracker says of them. Times on one monotonic clock [ns].
class Flown {
 public:
  void add(CommittedTrajectory committed);
  /// The tracker's word. At rest it also tells where the vehicle hovers.
  void hear(const Tracking& tracking, std::int64_t now_ns);
  /// The tracker's answer to a commit. @return whether what is flown was lost by it
  bool answer(std::uint64_t id, bool accepted, std::int64_t now_ns);
  /// The tracker brakes by itself: nothing is joined until it holds again.
  void lose();

  /// The tracker has spoken, but not for kTrackerSilent_s: what it flies is not known.
  bool tracker_is_silent(std::int64_t now_ns) const;
  /// The state that the vehicle is to have then; nothing: it is not known.
  std::optional<FlatState> at(std::int64_t time_ns) const;
  /// From then on nothing moves it.
  bool rests_from(std::int64_t time_ns) const;
  /// The newest commit that has not come to rest by now; nullptr: none.
  const CommittedTrajectory* newest(std::int64_t now_ns) const;
  /// All that is still to be flown: what moves now, and what waits.
  const std::vector<CommittedTrajectory>& legs() const { return legs_; }

 private:
  std::int64_t end_ns(const CommittedTrajectory& leg) const;
  const CommittedTrajectory* leg_at(std::int64_t time_ns) const;
  void forget_flown(std::int64_t now_ns);

  std::vector<CommittedTrajectory> legs_;  // by start
  std::uint64_t accepted_ = 0;             // the newest that the tracker has taken
  std::optional<Vec3> hovers_map_;         // where it holds
  std::optional<std::int64_t> heard_ns_;   // when it last spoke
};

inline constexpr double kTrackerSilent_s = 2.0;

}  // namespace goshawk::guard
