#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "goshawk/core/free_space.hpp"
#include "goshawk/guard/config.hpp"
#include "goshawk/guard/curve.hpp"
#include "goshawk/guard/flown.hpp"
#include "goshawk/guard/repair.hpp"

namespace goshawk::guard {

/// What becomes of a plan. In the order of the constants VERDICT_* of GuardVerdict.
enum class Verdict : std::uint8_t {
  passed,    // flown as it was planned
  slowed,    // the same curve, flown slower
  replaced,  // another trajectory along the same curve
  refused    // not flown: what was flown before is flown to its end
};
std::string_view to_string(Verdict verdict);

struct Decision {
  std::uint64_t plan = 0;  // number of the plan, from 1
  PlanKind kind = PlanKind::path;
  Verdict verdict = Verdict::refused;
  bool trimmed = false;                // a stop part ends it before its own end
  std::uint64_t commit_id = 0;         // 0: none
  Error reason{ErrorCode::ok, ""};     // ok, or why it is not flown as planned
  std::optional<Vec3> place_map = {};  // [m] that the sentence is about
  double deviation_m = 0.0;  // proved: nothing that is flown is further from the planned curve
};

/// A trajectory to fly.
struct Commit {
  CommittedTrajectory trajectory;
  PlanKind kind = PlanKind::path;
};

/// Makes other planners' plans safe. What it commits begins in the state that the vehicle will
/// have, keeps the limits, and ends at rest in space that the newest map shows free: proved along
/// the whole curve, whatever the plan was. A plan that is not flown changes nothing: what was
/// committed before is flown to its own rest. So the vehicle is safe without any further plan.
///
/// Each plan is tried as it is, then slower, then joined by a short curve, then as another
/// trajectory along the same curve. What leads through an obstacle, or through space that was never
/// seen, gets a stop part before that; with each map the stop moves back as far as the map allows.
///
/// Knows no middleware and no clock: every event brings the time [ns], on one monotonic clock.
class Guard {
 public:
  /// @param repair not null @param first_id number of the first commit, above 0: unique over
  /// restarts
  Guard(const Config& config, std::unique_ptr<Repair> repair, std::uint64_t first_id);

  /// Holds from the next plan on. @return invalid_limits, or invalid_parameter for what cannot
  /// change at run time; then as before
  Status reconfigure(const Config& config);

  /// @pre grid->check() ok
  void set_map(std::shared_ptr<const VoxelGrid> grid, std::int64_t now_ns);
  /// The heading that the next commit from rest keeps. Before the first no plan is flown.
  void on_heading(double yaw_rad) { yaw_rad_ = yaw_rad; }
  void on_tracking(const Tracking& tracking, std::int64_t now_ns) { flown_.hear(tracking, now_ns); }
  /// The tracker's answer to a commit, or that it has lost it.
  void on_tracker_answer(std::uint64_t id, const Error& outcome, std::int64_t now_ns);

  Decision on_plan(const Plan& plan, std::int64_t now_ns);
  /// A message that is no plan. @return the decision that says so
  Decision refuse(PlanKind kind, const Error& why, std::int64_t now_ns);

  /// Regularly. @return stage_silent, once: a planner that sent plan after plan has fallen silent
  /// while the vehicle flies
  std::optional<Error> check_silence(std::int64_t now_ns);

  std::vector<Commit> take_commits() { return std::exchange(commits_, {}); }
  const Flown& flown() const { return flown_; }

 private:
  struct Join {                 // where a plan is begun
    FlatState state;            // that the vehicle has
    std::int64_t start_ns = 0;  // then
    double plan_s = 0.0;        // of the plan's curve
    bool at_rest = false;       // nothing moves the vehicle before
  };
  struct Refusal {
    Error error;
    std::optional<Vec3> place_map = {};
  };
  template <typename T>
  using Or = std::variant<T, Refusal>;
  struct Candidate {
    CertifiedTrajectory nominal;
    double deviation_m = 0.0;
    std::optional<Refusal> cut = {};  // why its path ends before the plan's does
  };

  // join.cpp
  Or<Join> join_now(std::int64_t start_ns) const;
  Or<Join> join_of(const Plan& plan, const Curve& curve, std::int64_t now_ns) const;
  // candidates.cpp
  Or<Candidate> exactly(const Curve& curve, const Join& join) const;
  Or<Candidate> slowed(const Curve& curve, const Join& join) const;
  Or<Candidate> blended(const Curve& curve, const Join& join, double over_s) const;
  Or<Candidate> proved(Trajectory trajectory, const FlatState& start, double deviation_m) const;
  using Use = double(const BezierPiece&, const Limits&);
  static std::optional<Refusal> excess_of(const Trajectory& trajectory, const Limits& limits,
                                          Use* use_of_piece);
  // repaired.cpp
  Or<Candidate> repaired(const Curve& curve, const Join& join) const;
  Or<Candidate> along(std::vector<Vec3> points, const Outline& planned, double v_most_m_s,
                      const Join& join) const;
  RepairTask task_of(const std::vector<Vec3>& way, double error_m, double v_most_m_s,
                     const Join& join) const;
  std::optional<Refusal> cut_before_obstacle(std::vector<Vec3>& points) const;
  // guard.cpp
  Status check_ready(std::int64_t now_ns) const;
  void decide(const Plan& plan, std::int64_t now_ns, Decision& decision);
  void fly_along(const Waypoints& waypoints, std::int64_t now_ns, Decision& decision);
  void fly(const Plan& plan, const Curve& curve, std::int64_t now_ns, Decision& decision);
  bool take(Or<Candidate> candidate, Verdict verdict, const Join& join, Decision& decision);
  void move_stop(std::int64_t now_ns);
  static void note(const Refusal& refusal, Decision& decision);
  static void add_cut(const Refusal& cut, Decision& decision);

  Config config_;
  std::unique_ptr<Repair> repair_;
  FreeSpace space_;
  Flown flown_;
  std::vector<Commit> commits_;
  std::uint64_t next_id_;
  std::uint64_t plans_ = 0;
  std::optional<double> yaw_rad_;
  PlanKind flown_kind_ = PlanKind::path;
  std::optional<std::int64_t> heard_ns_;  // when the last plan came
  bool repeats_ = false;                  // plans come one after another
};

}  // namespace goshawk::guard
