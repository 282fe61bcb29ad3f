#include <cmath>
#include <optional>
#include <utility>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/flight_check/config.hpp"
#include "goshawk/flight_check/planned_track.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "octomap_msgs.h"

namespace goshawk::flight_check {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

constexpr double kAfterLanding_s = 1.0;  // how long after its end a leg still counts as flown

double seconds(std::int64_t ns) {
  return double(ns) * 1e-9;
}

/// octomap_binary, committed_trajectory, odom or odom_true -> stage_report: each committed
/// trajectory's verdict when it comes, the flown leg's when it is over, and a contact at once.
class FlightCheckComponent : public Component {
 public:
  explicit FlightCheckComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>()),
        reporter_(node, StageRole::flight_check, "fcl") {
    if (auto status = config_.body.check(); !status) throw StartupFault(status.error());
    node.subscribe<octomap_msgs::msg::Octomap>(
        "octomap_binary", Qos::latched(),
        [this](const octomap_msgs::msg::Octomap& m, const MessageInfo&) { on_map(m); });
    node.subscribe<msg::CommittedTrajectory>(
        "committed_trajectory", Qos::latched(),
        [this](const msg::CommittedTrajectory& m, const MessageInfo& info) { on_commit(m, info); });
    node.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(100),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
          if (!knows_truth_) on_odometry(m);
        });
    node.subscribe<nav_msgs::msg::Odometry>(
        "odom_true", Qos::best_effort(100),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
          if (!std::exchange(knows_truth_, true)) track_.clear();
          on_odometry(m);
        });
    node.every(config_.period_s, [this] { judge_flown(); });
    reporter_.ready("judges a body of reach " + std::to_string(config_.body.reach_m()) + " m");
  }

 private:
  struct Leg {
    std::uint64_t id = 0;
    double end_s = 0.0;
    std::optional<Verdict> flown = {};  // the part so far
    bool reported = false;
  };

  void on_map(const octomap_msgs::msg::Octomap& m) {
    if (!m.binary() || m.id() != "OcTree") {
      return reporter_.fault(
          fail(ErrorCode::map_malformed, "octomap_binary carries no binary OcTree: not judged"));
    }
    const std::string_view payload(reinterpret_cast<const char*>(m.data().data()), m.data().size());
    auto check = FlightCheck::from_payload(payload, m.resolution(), config_.body, config_.options);
    if (!check) return reporter_.fault(check.error());
    check_ = std::move(*check);
  }

  void on_commit(const msg::CommittedTrajectory& m, const MessageInfo& info) {
    finish_leg();
    const std::uint64_t id = m.nominal().request().id();
    const auto committed = conversions::from_msg(m);
    if (!committed) return reporter_.failed(id, committed.error());
    if (!check_)
      return reporter_.failed(id, fail(ErrorCode::no_map, "no map came yet: not judged"));
    leg_ = Leg{.id = id,
               .end_s = seconds(committed->start_time_ns()) + committed->flown().duration_s()};
    const auto [verdict, compute_ns] = timed([&] { return judge_planned(*committed); });
    const Timing timing{.wire_ns = wire_time_ns(m.header(), info), .compute_ns = compute_ns};
    if (!verdict) return reporter_.failed(id, verdict.error(), timing);
    report(id, "planned", *verdict, timing);
  }

  // The nominal part to its end, and what is flown if nothing newer comes.
  Result<Verdict> judge_planned(const CommittedTrajectory& committed) const {
    auto nominal = judge_planned(committed.nominal().trajectory(), committed);
    if (!nominal || !committed.stop()) return nominal;
    auto stopped = judge_planned(committed.flown(), committed);
    return !stopped || worse(*stopped, *nominal) ? stopped : nominal;
  }

  Result<Verdict> judge_planned(const Trajectory& trajectory,
                                const CommittedTrajectory& committed) const {
    std::vector<PlannedPiece> pieces;
    for (const auto& piece : trajectory.pieces) {
      PlannedPiece p;
      for (int j = 0; j < 6; ++j)
        p.control_points_map[std::size_t(j)] = piece.control_points.col(j);
      p.duration_s = piece.duration_s;
      pieces.push_back(p);
    }
    const auto track =
        planned_track(pieces, 0.01, [&](double t_s) { return committed.yaw_at(t_s); });
    if (!track) return track.error();
    return check_->judge(*track);
  }

  void on_odometry(const nav_msgs::msg::Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return;  // the tracker reports bad odometry
    const double t_s = seconds(conversions::to_ns(m.header().stamp()));
    if (!track_.empty() && t_s < track_.back().t_s) track_.clear();  // a clock that began anew
    track_.push_back({t_s, state->position_map, state->q_map_base});
  }

  // What was flown since the last time, joined to it without a gap.
  void judge_flown() {
    if (!check_ || track_.size() < 2) return;
    const auto verdict = check_->judge(track_);
    track_.erase(track_.begin(), track_.end() - 1);
    if (!verdict) return reporter_.fault(verdict.error());
    if (verdict->touched && !touching_) {
      reporter_.failed(leg_ ? leg_->id : 0, fail(ErrorCode::collision, verdict->sentence));
    }
    touching_ = verdict->touched;
    if (!leg_) return;
    if (!leg_->flown || worse(*verdict, *leg_->flown)) leg_->flown = *verdict;
    if (track_.back().t_s > leg_->end_s + kAfterLanding_s) finish_leg();
  }

  static bool worse(const Verdict& a, const Verdict& b) {
    return !b.touched && (a.touched || a.clearance_m < b.clearance_m);
  }

  void finish_leg() {
    if (!leg_ || leg_->reported || !leg_->flown) return;
    leg_->reported = true;
    report(leg_->id, "flown", *leg_->flown, {});
  }

  void report(std::uint64_t id, const std::string& what, const Verdict& v, Timing timing) {
    if (v.touched) {
      return reporter_.failed(id, fail(ErrorCode::collision, what + ": " + v.sentence), timing);
    }
    const Vec3& p = v.clearance_place_map;
    // A map without obstacles has no clearance that a number could tell.
    const double clearance_m = std::isfinite(v.clearance_m) ? v.clearance_m : 1e6;
    const std::string clearance = what + "_clearance_m";
    reporter_.answered(id, timing,
                       {{clearance.c_str(), clearance_m},
                        {"at_s", v.clearance_t_s},
                        {"x_m", p.x()},
                        {"y_m", p.y()},
                        {"z_m", p.z()},
                        {"poses", double(v.queries)}});
  }

  Node& node_;
  Config config_;
  StageReporter reporter_;
  std::optional<FlightCheck> check_;
  std::vector<Sample> track_;  // not judged yet, and the last that was
  std::optional<Leg> leg_;
  bool touching_ = false;
  bool knows_truth_ = false;  // a simulator with noisy sensors tells the truth beside them
};

}  // namespace
}  // namespace goshawk::flight_check

GOSHAWK_REGISTER_COMPONENT(goshawk::flight_check::FlightCheckComponent,
                           goshawk::flight_check::Config)
