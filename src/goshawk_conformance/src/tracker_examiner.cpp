#include "tracker_examiner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "world.hpp"

namespace goshawk::conformance {
namespace {

namespace msg = goshawk_msgs::msg;
namespace mode = goshawk_msgs::msg::TrackingState_Constants;
using runtime::MessageInfo;
using runtime::Qos;

constexpr std::int64_t kPeriod_ns = 10'000'000;  // of odometry
constexpr double kMostError_m = 0.25;            // for any tracker, in calm air, at 1 m/s
constexpr double kStall_s = 0.08;  // without odometry or commands: the machine stalled
constexpr int kAttempts = 10;

// Position of a committed trajectory, by de Casteljau.
Vec3 wanted(const msg::CommittedTrajectory& m, double time_s) {
  const auto& pieces = m.nominal().pieces();
  std::size_t k = 0;
  time_s = std::max(0.0, time_s);
  while (k + 1 < pieces.size() && time_s > pieces[k].duration()) time_s -= pieces[k++].duration();
  const double u = std::min(1.0, time_s / pieces[k].duration());
  Vec3 points[6];
  for (std::size_t j = 0; j < 6; ++j) {
    const auto& p = pieces[k].control_points()[j];
    points[j] = Vec3(p.x(), p.y(), p.z());
  }
  for (int n = 5; n > 0; --n) {
    for (int j = 0; j < n; ++j) points[j] += u * (points[j + 1] - points[j]);
  }
  return points[0];
}

double duration_s(const msg::CommittedTrajectory& m) {
  double sum_s = 0.0;
  for (const auto& piece : m.nominal().pieces()) sum_s += piece.duration();
  return sum_s;
}

msg::Polytope box_around(const Vec3& a, const Vec3& b, double margin_m) {
  msg::Polytope box;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      Vec3 normal = Vec3::Zero();
      normal[axis] = side;
      box.normals().insert(box.normals().end(), normal.data(), normal.data() + 3);
      box.offsets().push_back(std::max(side * a[axis], side * b[axis]) + margin_m);
    }
  }
  return box;
}

}  // namespace

TrackerExaminer::TrackerExaminer(runtime::Context& context, const Options& options)
    : options_(options),
      node_(context, "goshawk_conform", in_namespace(options.node_namespace)),
      listener_(node_, options.stage),
      odometry_(node_.advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort())),
      commits_(node_.advertise<Committed>("committed_trajectory", Qos::latched())),
      maps_(node_.advertise<msg::VoxelGrid>("map/voxels", Qos::latched())) {
  vehicle_.position_map = Vec3(1.0, 2.0, 1.5);
  node_.subscribe<msg::AttitudeSetpoint>(
      "command", Qos::best_effort(10),
      [this](const msg::AttitudeSetpoint& m, const MessageInfo& i) { take(m, i.received_ns); });
  node_.subscribe<msg::TrackingState>("tracking_state", Qos::best_effort(),
                                      [this](const auto& m, const auto&) { state_ = m; });
}

Result<Report> TrackerExaminer::examine(const std::vector<Committed>& recorded) {
  const std::int64_t end_ns = node_.now_ns() + std::int64_t(options_.ready_timeout_s * 1e9);
  while (odometry_.matched() == 0 && node_.now_ns() < end_ns) node_.spin_some(0.02);
  if (odometry_.matched() == 0) {
    return fail(ErrorCode::stage_silent, "no node reads odom: is " + options_.stage +
                                             " running, in this domain and namespace?");
  }
  report_.stage = options_.stage;
  for (const auto& m : recorded) map_version_ = std::max(map_version_, m.map_version());
  send_map(false);
  live(2.0, [&] { return listener_.ready(); });
  report_.items.push_back(
      {"reports that it is ready", listener_.ready(),
       listener_.ready() ? "" : "no stage_report of request 0 with code ok came"});
  live(10.0 * options_.timeout_s, [&] { return commands_ >= 20; });
  report_.items.push_back(
      {"answers odometry with commands", commands_ >= 20, fmt::format("{} commands", commands_)});
  if (commands_ >= 20) {
    weigh();
    examine_flight("flies a trajectory", [&] { return straight(Vec3(0.6, 0.3, 0.2), 3.5); });
    examine_bad();
    for (const auto& m : recorded) {
      const auto& p = m.nominal().pieces().front().control_points()[0];
      examine_flight(fmt::format("flies recorded trajectory {}", m.nominal().request().id()), [&] {
        fly_to(Vec3(p.x(), p.y(), p.z()));
        return m;
      });
    }
    examine_bad_odometry();
    examine_garbage();
    examine_silence();
  }
  report_.items.push_back(valid_.item());
  add_latency(report_, std::move(latencies_s_));
  report_.implementation = listener_.implementation();
  return report_;
}

bool TrackerExaminer::live(double timeout_s, const std::function<bool()>& done) {
  const std::int64_t end_ns = node_.now_ns() + std::int64_t(timeout_s * 1e9);
  while (!done() && node_.now_ns() < end_ns) {
    if (node_.now_ns() >= next_ns_) {
      move();
      send_odometry();
      next_ns_ = std::max(next_ns_ + kPeriod_ns, node_.now_ns());
    }
    node_.spin_some(std::clamp(double(next_ns_ - node_.now_ns()) * 1e-9, 0.0, 0.02));
  }
  return done();
}

// Advances to the present: during a stall of the machine the last command holds.
void TrackerExaminer::move() {
  const std::int64_t now_ns = node_.now_ns();
  const double dt_s = moved_ns_ == 0 ? 0.0 : double(now_ns - moved_ns_) * 1e-9;
  moved_ns_ = now_ns;
  longest_gap_s_ = std::max(longest_gap_s_, dt_s);
  if (weight_n_ <= 0.0 || !command_) return;
  const Vec3 thrust = command_->q_map_base * Vec3(0.0, 0.0, command_->thrust_n);
  const Vec3 acceleration = kGravity_m_s2 / weight_n_ * thrust - Vec3(0.0, 0.0, kGravity_m_s2);
  vehicle_.position_map += dt_s * vehicle_.velocity_map + 0.5 * dt_s * dt_s * acceleration;
  vehicle_.velocity_map += dt_s * acceleration;
  vehicle_.q_map_base = command_->q_map_base;
}

void TrackerExaminer::send_odometry() {
  nav_msgs::msg::Odometry m;
  conversions::fill_msg(vehicle_, m);
  m.header(conversions::make_header(moved_ns_));
  (void)odometry_.publish(m);
}

void TrackerExaminer::take(const msg::AttitudeSetpoint& m, std::int64_t received_ns) {
  ++commands_;
  if (commanded_ns_ > 0) {
    longest_gap_s_ = std::max(longest_gap_s_, double(received_ns - commanded_ns_) * 1e-9);
  }
  commanded_ns_ = received_ns;
  const auto command = conversions::from_msg(m);
  const bool stamped = conversions::to_ns(m.header().stamp()) > 0;
  valid_.check(command && stamped && command->thrust_n >= 0.0,
               !command ? command.error().message
                        : fmt::format("it has no stamp, or a thrust of {:.3g} N", m.thrust()));
  if (!command) return;
  if (moved_ns_ > 0) latencies_s_.push_back(double(received_ns - moved_ns_) * 1e-9);
  command_ = *command;
}

// Free everywhere around, or with a layer of obstacles above the vehicle.
void TrackerExaminer::send_map(bool blocked_above) {
  VoxelGrid grid;
  grid.geometry = {
      .origin_map = {-64.0, -64.0, -16.0}, .resolution_m = 1.0, .size = {128, 128, 64}};
  grid.grown = BitGrid(grid.geometry.size, true);
  grid.version = ++map_version_;
  const int above = int(std::floor(vehicle_.position_map.z() + 2.0 + 16.0));
  for (int y = 0; blocked_above && y < 128; ++y) grid.grown.set_run(0, 128, y, above, true);
  msg::VoxelGrid m;
  conversions::fill_msg(grid, m);
  m.header(conversions::make_header(node_.now_ns()));
  (void)maps_.publish(m);
}

// It hovers: its thrust is the weight.
void TrackerExaminer::weigh() {
  double sum_n = 0.0;
  int count = 0;
  const int before = commands_;
  live(10.0 * options_.timeout_s, [&] {
    if (commands_ > before + count && command_) {
      ++count;
      sum_n += command_->thrust_n;
    }
    return count >= 20;
  });
  weight_n_ = count > 0 ? sum_n / count : 0.0;
  report_.items.push_back(
      {"hovers with a thrust above zero", weight_n_ > 0.0, fmt::format("{:.2f} N", weight_n_)});
}

TrackerExaminer::Committed TrackerExaminer::straight(const Vec3& by, double duration_s) {
  const Vec3 from = vehicle_.position_map;
  const Vec3 to = from + by;
  PlanRequest request;
  request.start.position = from;
  request.goal.position = to;
  request.limits = {.v_max_m_s = 1.5, .a_max_m_s2 = 1.5};
  request.id = 1;
  request.stamp_ns = node_.now_ns();
  msg::BezierPiece piece;
  piece.duration(duration_s);
  for (std::size_t j = 0; j < 6; ++j) {
    piece.control_points()[j] = conversions::to_point(j < 3 ? from : to);  // rest to rest
  }
  Committed m;
  m.nominal().request(conversions::to_msg(request));
  m.nominal().implementation("goshawk_conform");
  m.nominal().pieces({piece});
  m.nominal().polytopes({box_around(from, to, 0.5)});
  m.header(conversions::make_header(node_.now_ns()));
  m.nominal().header(m.header());
  m.nominal().map_version(map_version_);
  m.map_version(map_version_);
  return m;
}

std::int64_t TrackerExaminer::commit(Committed committed, double begins_in_s) {
  listener_.listen(++id_);
  committed.nominal().request().id(id_);
  const std::int64_t now_ns = node_.now_ns();
  const std::int64_t begin_ns = now_ns + std::int64_t(begins_in_s * 1e9);
  committed.header().stamp(conversions::to_stamp(now_ns));
  committed.start_time(conversions::to_stamp(begin_ns));
  (void)commits_.publish(committed);
  return begin_ns;
}

bool TrackerExaminer::fly_to(const Vec3& position) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Vec3 by = position - vehicle_.position_map;
    if (by.norm() < 0.02) return true;
    (void)fly(straight(by, std::max(3.5 * by.norm(), 4.0 * std::sqrt(by.norm()))));
  }
  return false;
}

TrackerExaminer::Flight TrackerExaminer::fly(const Committed& committed) {
  Flight flight;
  longest_gap_s_ = 0.0;
  const std::int64_t begin_ns = commit(committed, kBegins_in_s);
  const double lasts_s = duration_s(committed);
  live(std::max(kBegins_in_s + lasts_s + 0.5, options_.timeout_s), [&] {
    const double time_s = double(moved_ns_ - begin_ns) * 1e-9;
    flight.worst_m =
        std::max(flight.worst_m, (wanted(committed, time_s) - vehicle_.position_map).norm());
    flight.followed |= state_.mode() == mode::MODE_FOLLOW && state_.request_id() == id_;
    return time_s > lasts_s + 0.5;
  });
  flight.left_m = (wanted(committed, lasts_s) - vehicle_.position_map).norm();
  flight.accepted = !listener_.reports().empty() && listener_.reports().front().code() == "ok";
  flight.said =
      listener_.reports().empty() ? "no report came" : listener_.reports().back().message();
  flight.holds = state_.mode() == mode::MODE_HOLD;
  flight.gap_s = longest_gap_s_;
  return flight;
}

// If the machine stalls, odometry or commands are missing for so long that every tracker must give
// up: such a flight is flown again.
TrackerExaminer::Flight TrackerExaminer::fly_undisturbed(const std::function<Committed()>& make) {
  Flight flight;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    flight = fly(make());
    if ((flight.good() && flight.worst_m <= kMostError_m) || flight.gap_s < kStall_s) break;
  }
  return flight;
}

void TrackerExaminer::examine_flight(const std::string& name,
                                     const std::function<Committed()>& make) {
  const Flight f = fly_undisturbed(make);
  const auto add = [&](const char* what, bool passed, const std::string& detail) {
    report_.items.push_back({name + ": " + what, passed, detail});
  };
  add("accepts it", f.accepted, f.accepted ? "" : f.said);
  add("stays on it", f.worst_m <= kMostError_m,
      fmt::format("largest error {:.3f} m; longest silence {:.3f} s", f.worst_m, f.gap_s));
  add("arrives and holds", f.arrived(),
      fmt::format("{:.3f} m from its end, in mode {}", f.left_m,
                  conversions::tracking_mode_word(state_.mode())));
  add("reports that it follows", f.followed,
      f.followed ? "" : "tracking_state never named it in MODE_FOLLOW");
}

}  // namespace goshawk::conformance
