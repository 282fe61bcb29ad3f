#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/flight_check/config.hpp"
#include "goshawk/flight_check/planned_track.hpp"
#include "goshawk/flight_check/watch.hpp"
#include "goshawk/movers/movers_file.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "octomap_msgs.h"

namespace goshawk::flight_check {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;
using nav_msgs::msg::Odometry;
using octomap_msgs::msg::Octomap;

constexpr double kPlanStep_s = 0.01;

double seconds(std::int64_t ns) {
  return double(ns) * 1e-9;
}

std::vector<PlannedPiece> pieces_of(const Trajectory& trajectory) {
  std::vector<PlannedPiece> pieces;
  for (const auto& piece : trajectory.pieces) {
    PlannedPiece p;
    for (int j = 0; j < 6; ++j) p.control_points_map[std::size_t(j)] = piece.control_points.col(j);
    p.duration_s = piece.duration_s;
    pieces.push_back(p);
  }
  return pieces;
}

Result<Plan> plan_of(const msg::CommittedTrajectory& m) {
  const auto committed = conversions::from_msg(m);
  if (!committed) return committed.error();
  const auto yaw = [&](double t_s) { return committed->yaw_at(t_s); };
  const auto track_of = [&](const CertifiedTrajectory& part, double start_s) {
    return planned_track(pieces_of(part.trajectory()), kPlanStep_s, yaw, start_s);
  };
  auto nominal = track_of(committed->nominal(), 0.0);
  if (!nominal) return nominal.error();
  Plan plan{committed->id(), seconds(committed->start_time_ns()), *std::move(nominal), {}};
  if (!committed->stop()) return plan;
  auto stop = track_of(committed->stop()->trajectory, committed->stop()->after_s);
  if (!stop) return stop.error();
  plan.stop = *std::move(stop);
  return plan;
}

/// octomap_binary, committed_trajectory, odom or odom_true -> stage_report: a verdict on each
/// committed trajectory at once, on the flown leg when it is over, and on a contact at once.
class FlightCheckComponent : public Component {
 public:
  explicit FlightCheckComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>()),
        reporter_(node, StageRole::flight_check, "fcl") {
    if (auto status = config_.body.check(); !status) throw StartupFault(status.error());
    if (!config_.movers_file.empty()) watch_.set_movers(read_movers());
    node.subscribe<Octomap>(
        "octomap_binary", Qos::latched(),
        [this](const Octomap& m, const MessageInfo&) { new_map_ = m; },
        Writers::one("octomap_binary"));
    node.subscribe<msg::CommittedTrajectory>(
        "committed_trajectory", Qos::latched(),
        [this](const msg::CommittedTrajectory& m, const MessageInfo& info) { on_commit(m, info); },
        Writers::one("committed_trajectory"));
    node.subscribe<Odometry>(
        "odom", Qos::best_effort(100),
        [this](const Odometry& m, const MessageInfo&) {
          if (!knows_truth_) on_odometry(m);
        },
        Writers::one("odom"));
    node.subscribe<Odometry>(
        "odom_true", Qos::best_effort(100),
        [this](const Odometry& m, const MessageInfo&) {
          if (!std::exchange(knows_truth_, true)) watch_.forget_track();
          on_odometry(m);
        },
        Writers::one("odom_true"));
    node.subscribe<msg::VehicleStatus>(
        "vehicle_status", Qos::best_effort(),
        [this](const msg::VehicleStatus& m, const MessageInfo&) { on_status(m); },
        Writers::one("vehicle_status"));
    node.every(config_.period_s, [this] {
      read_map();
      watch_.tick(seconds(node_.now_ns()));
      tell(watch_.take_findings(), {});
    });
    reporter_.ready(fmt::format("judges a body of reach {:.3g} m", config_.body.reach_m()));
  }

 private:
  MoverCheck read_movers() const {
    auto movers = movers::read_movers(config_.movers_file);
    if (!movers) throw StartupFault(movers.error());
    auto check = MoverCheck::create(*std::move(movers), config_.movers_start_s, config_.body,
                                    config_.options);
    if (!check) throw StartupFault(check.error());
    return *std::move(check);
  }

  /// The newest map is read when it is needed: others may have come before it.
  void read_map() {
    if (!new_map_) return;
    const auto m = std::exchange(new_map_, {});
    if (!m->binary() || m->id() != "OcTree") {
      return reporter_.fault(fail(ErrorCode::map_malformed,
                                  "octomap_binary does not hold a binary OcTree: nothing can be "
                                  "judged against it"));
    }
    const std::string_view bytes(reinterpret_cast<const char*>(m->data().data()), m->data().size());
    auto check = FlightCheck::from_payload(bytes, m->resolution(), config_.body, config_.options);
    if (!check) return reporter_.fault(check.error());
    watch_.set_map(*std::move(check));
  }

  void on_commit(const msg::CommittedTrajectory& m, const MessageInfo& info) {
    read_map();
    const auto [findings, compute_ns] = timed([&] {
      if (auto plan = plan_of(m)) {
        watch_.commit(*std::move(plan));
      } else {
        watch_.commit_unjudged(m.nominal().request().id(), plan.error());
      }
      return watch_.take_findings();
    });
    tell(findings, {.wire_ns = wire_time_ns(m.header(), info), .compute_ns = compute_ns});
  }

  void on_odometry(const Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return;  // the tracker reports bad odometry
    const double t_s = seconds(conversions::to_ns(m.header().stamp()));
    watch_.fly({{t_s, state->position_map, state->q_map_base}, state->velocity_map.norm()});
  }

  /// A counter that goes back is that of a restarted plant, which hovers where it begins.
  void on_status(const msg::VehicleStatus& m) {
    if (std::exchange(resets_, m.resets()) != m.resets()) watch_.forget_track();
  }

  /// @param timing of the verdict on a plan
  void tell(const std::vector<Finding>& findings, const Timing& timing) {
    for (const auto& finding : findings) {
      switch (finding.kind) {
        case Finding::Kind::planned:
          report(finding, "planned", timing);
          break;
        case Finding::Kind::flown:
          report(finding, "flown", {});
          break;
        case Finding::Kind::contact:
          reporter_.failed(finding.request_id,
                           fail(ErrorCode::collision, finding.outcome->sentence));
          break;
        case Finding::Kind::mover:
          reporter_.failed(finding.request_id, finding.outcome.error());
          break;
        case Finding::Kind::event:
          reporter_.fault(finding.outcome.error());
          break;
      }
    }
  }

  void report(const Finding& finding, const std::string& what, const Timing& timing) {
    const std::uint64_t id = finding.request_id;
    if (!finding.outcome) return reporter_.failed(id, finding.outcome.error(), timing);
    const Verdict& v = *finding.outcome;
    const std::string movers = finding.movers ? "; " + finding.movers->sentence() : "";
    if (v.touched || (finding.movers && !finding.movers->touched.empty())) {
      return reporter_.failed(id, fail(ErrorCode::collision, what + ": " + v.sentence + movers),
                              timing);
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
                        {"poses", double(v.queries)}},
                       finding.movers ? finding.movers->sentence() : "");
  }

  Node& node_;
  Config config_;
  StageReporter reporter_;
  std::optional<Octomap> new_map_;  // not read yet
  Watch watch_;
  std::uint32_t resets_ = 0;  // of the vehicle's position
  bool knows_truth_ = false;  // a simulator with noisy sensors tells the truth beside them
};

}  // namespace
}  // namespace goshawk::flight_check

GOSHAWK_REGISTER_COMPONENT(goshawk::flight_check::FlightCheckComponent,
                           goshawk::flight_check::Config)
