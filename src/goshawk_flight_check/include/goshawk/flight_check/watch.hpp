#pragma once

#include <optional>
#include <set>
#include <vector>

#include "goshawk/flight_check/discontinuity.hpp"
#include "goshawk/flight_check/flight_check.hpp"
#include "goshawk/flight_check/mover_check.hpp"

namespace goshawk::flight_check {

/// A trajectory that is to be flown.
struct Plan {
  std::uint64_t request_id = 0;
  double start_s = 0.0;         // [s] when it begins, on the clock of the odometry
  std::vector<Sample> nominal;  // to the goal; times count from the start
  std::vector<Sample> stop;     // to rest, from where it leaves the nominal part; or empty
};

/// What a watch has to say.
struct Finding {
  enum class Kind {
    planned,  // about a plan, before it is flown; again if a newer map says otherwise
    flown,    // about what was flown of a plan, when it is over
    contact,  // the vehicle touches something of the map now
    mover,    // the vehicle touches something that moves now; movers says what
    event,    // odometry that is not a path; outcome says what
  };
  Kind kind = Kind::event;
  std::uint64_t request_id = 0;          // 0: about no plan
  Result<Verdict> outcome;               // or why there is none; for a mover: its failure
  std::optional<MoverVerdict> movers{};  // of what was flown, if it is known what moves
};

/// The second opinion in flight: judges every plan when it is made and every part of the flight
/// soon after it was flown. Time is an argument; nothing is said twice.
class Watch {
 public:
  /// From here on this map counts. What is left of the plan is judged anew at the next tick.
  void set_map(FlightCheck check);

  /// From here on what is flown is judged against these as well; plans are not.
  void set_movers(MoverCheck movers) { movers_ = std::move(movers); }

  /// Judges the plan at once; it supersedes the one before, whose flown part is told.
  void commit(Plan plan);
  /// A plan that cannot be judged. It supersedes the one before as well.
  void commit_unjudged(std::uint64_t request_id, const Error& why);

  /// A sample of odometry. What lies between it and the sample before is judged at the next tick,
  /// unless it cannot have been flown (discontinuity()).
  void fly(const LiveSample& sample);

  /// The vehicle's position was reset: what comes next has nothing to do with what came before.
  void forget_track();

  /// Judges what was flown since the last tick. @param now_s [s] on the clock of the odometry
  void tick(double now_s);

  /// @return what was found since the last call, in order
  std::vector<Finding> take_findings() { return std::exchange(findings_, {}); }

 private:
  struct Leg {
    std::uint64_t id = 0;
    double end_s = 0.0;
    std::optional<Verdict> flown;  // the worst so far
    std::optional<MoverVerdict> movers{};
  };

  void judge_plan_anew(double now_s);
  void judge_flown();
  void judge_movers(std::span<const Sample> track);
  void finish_leg();
  void end_track(const std::string& why);
  double below_m() const;

  std::optional<FlightCheck> check_;
  bool map_is_new_ = false;
  std::optional<Plan> plan_;     // newest, until it is known to touch
  bool plan_is_judged_ = false;  // against any map
  std::optional<Leg> leg_;       // until it is told
  std::uint64_t newest_id_ = 0;
  std::vector<Sample> track_;  // not judged yet, and the last that was
  std::optional<LiveSample> last_;
  bool touching_ = false;
  std::optional<MoverCheck> movers_;
  std::set<std::uint64_t> touching_movers_;
  std::vector<Finding> findings_;
};

}  // namespace goshawk::flight_check
