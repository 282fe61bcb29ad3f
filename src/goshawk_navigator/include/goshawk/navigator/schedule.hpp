#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/core/committed_trajectory.hpp"

namespace goshawk::navigator {

/// A committed trajectory, and how it stands.
struct Leg {
  CommittedTrajectory committed;
  bool brakes = false;    // it leads to rest, and to no goal
  bool accepted = false;  // by the tracker
  double beyond_m = 0.0;  // [m] of the way that its plan leaves from its end to the goal
  /// The leg before it has the same nominal part, and an earlier stop: until the tracker has taken
  /// this one, that one is flown.
  bool continues = false;

  std::uint64_t id() const { return committed.id(); }
  std::int64_t start_ns() const { return committed.start_time_ns(); }
  std::int64_t end_ns() const;
  /// Does it come to rest before the goal: at its horizon, or on its stop part farther than so from
  /// where its nominal part ends?
  bool stops_early(double tolerance_m) const;
  /// At its end after it, at its start before it. @param time_ns as start_ns()
  FlatState at(std::int64_t time_ns) const;
};

/// What is flown now, and what has been committed for later: the tracker's queue, as the navigator
/// knows it. A leg ends when the next one begins.
class Schedule {
 public:
  /// Those that begin then or later are replaced, as in the tracker; the one that it continues is
  /// kept until the tracker has taken it.
  void add(Leg leg);
  /// The tracker did not take it: neither it nor what follows on it is flown, nor what it follows
  /// on if that was never answered: the tracker answers in order, so it has not heard that.
  void drop_refused(std::uint64_t id);
  /// The tracker did not take a leg that another one of the same nominal part stands for: that one
  /// alone is dropped. @return whether there is such a one
  bool drop_later_stop(std::uint64_t id);
  /// Nothing of it is flown any more.
  void clear() { legs_.clear(); }
  /// Forgets legs that another has replaced by now. What continues a leg replaces it once it is
  /// accepted.
  void forget_before(std::int64_t now_ns);

  /// @return what is flown, or held at its end, then; nullptr before the first leg
  const Leg* at(std::int64_t time_ns) const;
  Leg* find(std::uint64_t id);
  /// @return the newest, nullptr if there is none
  const Leg* last() const { return legs_.empty() ? nullptr : &legs_.back(); }
  bool empty() const { return legs_.empty(); }
  const std::vector<Leg>& legs() const { return legs_; }
  /// When the leg is replaced by the next one, or ends. @param leg one of legs()
  std::int64_t until_ns(const Leg& leg) const;
  /// From then on the vehicle rests. @pre not empty
  std::int64_t end_ns() const { return legs_.back().end_ns(); }
  /// Something is flown then, or will be.
  bool moves(std::int64_t time_ns) const { return !legs_.empty() && time_ns < end_ns(); }

 private:
  std::vector<Leg> legs_;  // by start
};

}  // namespace goshawk::navigator
