// What a tracker is told that it must not fly: bad trajectories, bad odometry, garbage, and
// silence.
#include <fmt/format.h>

#include <set>
#include <string>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "tracker_examiner.hpp"
#include "world.hpp"

namespace goshawk::conformance {
namespace {

using runtime::Qos;

const auto kNever = [] { return false; };

}  // namespace

void TrackerExaminer::examine_bad() {
  const auto refuse = [&](const char* name, const std::set<std::string>& codes, auto&& change,
                          double begins_in_s = kBegins_in_s) {
    Committed m = straight(Vec3(0.6, 0.0, 0.0), 3.0);
    change(m);
    commit(m, begins_in_s);
    live(options_.timeout_s, [&] { return !listener_.reports().empty(); });
    report_.items.push_back(listener_.refusal(name, codes));
  };
  const Vec3 before = vehicle_.position_map;
  refuse("a trajectory in another frame", {"wrong_frame"}, [](Committed& m) {
    m.header().frame_id("base_link");
    m.nominal().header().frame_id("base_link");
  });
  refuse("one without pieces", {"invalid_input"}, [](Committed& m) { m.nominal().pieces({}); });
  refuse("a control point that is not a number", {"invalid_input"},
         [](Committed& m) { m.nominal().pieces()[0].control_points()[3].y(kNan); });
  refuse("a piece of zero duration", {"invalid_input"},
         [](Committed& m) { m.nominal().pieces()[0].duration(0.0); });
  refuse("a piece without its polytope", {"invalid_input"},
         [](Committed& m) { m.nominal().pieces()[0].polytope(7); });
  refuse("a curve that leaves its polytope", {"not_certified"},
         [](Committed& m) { m.nominal().polytopes()[0].offsets()[0] -= 0.8; });
  refuse("one faster than its limits", {"not_certified"},
         [](Committed& m) { m.nominal().request().limits().v_max(0.5); });
  refuse("one that ends in motion", {"not_certified"}, [](Committed& m) {
    for (std::size_t j = 2; j < 6; ++j) {
      auto& p = m.nominal().pieces()[0].control_points()[j];
      p.x(p.x() - 0.1 * double(5 - j));
    }
  });
  refuse("one that begins elsewhere", {"not_at_start"}, [&](Committed& m) {
    const Vec3 here = vehicle_.position_map;
    vehicle_.position_map += Vec3(0.0, 3.0, 0.0);
    m = straight(Vec3(0.6, 0.0, 0.0), 3.0);
    vehicle_.position_map = here;
  });
  refuse(
      "one that ended long ago", {"deadline_exceeded"}, [](Committed&) {}, -60.0);
  refuse("one that no vehicle can fly", {"trajectory_infeasible"}, [&](Committed& m) {
    m = straight(Vec3(0.6, 0.0, 0.0), 0.1);
    m.nominal().request().limits().v_max(1e4);
    m.nominal().request().limits().a_max(1e4);
  });
  refuse("one of a map that never came", {"no_map"},
         [](Committed& m) { m.map_version(m.map_version() + 1000); });
  send_map(true);
  settle_map();
  refuse("one through an obstacle", {"trajectory_blocked"},
         [&](Committed& m) { m = straight(Vec3(0.0, 0.0, 3.0), 10.0); });
  send_map(false);
  settle_map();
  const double moved_m = (vehicle_.position_map - before).norm();
  report_.items.push_back({"stays in place after bad trajectories", moved_m < 0.1,
                           fmt::format("{:.3f} m away", moved_m)});
}

// A map comes by another topic than what is judged by it.
void TrackerExaminer::settle_map() {
  live(10.0 * options_.timeout_s, [&] { return maps_.wait_acknowledged(0.0); });
  live(0.5, kNever);  // the tracker has it; now it takes it up
}

void TrackerExaminer::examine_bad_odometry() {
  for (int k = 0; k < 5; ++k) {
    nav_msgs::msg::Odometry m;
    conversions::fill_msg(vehicle_, m);
    m.header(conversions::make_header(node_.now_ns()));
    m.pose().pose().position().x(kNan);
    (void)odometry_.publish(m);
    node_.spin_some(0.01);
  }
  const int before = commands_;
  const bool lives = live(10.0 * options_.timeout_s, [&] { return commands_ >= before + 20; });
  report_.items.push_back(
      {"survives odometry that is not finite", lives, lives ? "" : "no more commands came"});
}

// Bytes that are not a message, on both inputs; then everything must work as before.
void TrackerExaminer::examine_garbage() {
  const auto odometry = node_.advertise_raw(
      "odom", runtime::raw_message_type(runtime::message_type<nav_msgs::msg::Odometry>().name()),
      Qos::best_effort());
  const auto commits = node_.advertise_raw(
      "committed_trajectory", runtime::raw_message_type(runtime::message_type<Committed>().name()),
      Qos::latched());
  live(1.0, [&] { return odometry.matched() > 0 && commits.matched() > 0; });
  Random random(options_.seed);
  for (int k = 0; k < 10; ++k) {
    std::vector<unsigned char> bytes = {0, 1, 0, 0};
    for (int n = random.below(600); n > 0; --n) bytes.push_back((unsigned char)(random.below(256)));
    (void)odometry.publish_raw(&bytes);
    (void)commits.publish_raw(&bytes);
  }
  live(0.3, kNever);
  const int before = commands_;
  const bool lives = live(10.0 * options_.timeout_s, [&] { return commands_ >= before + 20; });
  report_.items.push_back({"survives garbage", lives, lives ? "" : "no more commands came"});
}

// A tracker without odometry must stop commanding.
void TrackerExaminer::examine_silence() {
  const auto wait = [&](double seconds) {
    const std::int64_t end_ns = node_.now_ns() + std::int64_t(seconds * 1e9);
    while (node_.now_ns() < end_ns) node_.spin_some(0.02);
  };
  wait(1.0);
  const int before = commands_;
  wait(0.5);
  report_.items.push_back({"stops commanding without odometry", commands_ == before,
                           fmt::format("{} commands", commands_ - before)});
}

}  // namespace goshawk::conformance
