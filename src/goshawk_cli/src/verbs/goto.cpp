#include <fmt/format.h>

#include <numbers>

#include "flight/pilot.hpp"
#include "json.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

struct PilotOptions {
  Vec3 goal_map = Vec3::Zero();
  std::optional<double> yaw_deg;
  std::string space = "/";
  double timeout_s = 120.0;
  double ready_s = 5.0;
};

int tell(const Arrival& arrival, const char* what, const Console& console) {
  if (console.json()) {
    Json object = ok_json();
    object.update({{"goal", to_json(arrival.goal_map)},
                   {"distance_m", arrival.distance_m},
                   {"time_s", arrival.time_s}});
    console.print(object);
  } else {
    fmt::print("{} {} after {:.1f} s, {:.3f} m from it\n", what, to_text(arrival.goal_map),
               arrival.time_s, arrival.distance_m);
  }
  return kDone;
}

/// @param hold the goal is where the vehicle is
int pilot(const PilotOptions& o, bool hold, const Console& console) {
  const auto space = introspection::full_topic_name(o.space);
  if (!space) return console.failed(space.error());
  auto session = introspection::Session::open();
  if (!session) return console.failed(session.error());
  Pilot pilot(**session, *space, [&](const std::string& sentence) { console.say(sentence); });
  if (auto status = pilot.wait_ready(o.ready_s); !status) return console.failed(status.error());
  const Vec3 goal_map = hold ? pilot.position_map() : o.goal_map;
  std::optional<double> yaw_rad;
  if (o.yaw_deg) yaw_rad = *o.yaw_deg * kDegree_rad;
  const auto arrival = pilot.go(goal_map, yaw_rad, o.timeout_s);
  if (!arrival) return console.not_done(arrival.error());
  return tell(*arrival, hold ? "holds at" : "arrived at", console);
}

void add_shared(const Verb& verb, PilotOptions& o) {
  verb->add_option("--namespace", o.space, "of the vehicle, as /uav1")->capture_default_str();
  verb->add_option("--timeout", o.timeout_s, "[s] longest wait for the vehicle")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  verb->add_option("--ready", o.ready_s, "[s] longest wait for the flight to be found")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
}

}  // namespace

void add_goto(Program& program) {
  const Verb verb = program.verb("goto", "send the vehicle of a running flight to a point");
  auto o = std::make_shared<PilotOptions>();
  add_point(verb, "goal", o->goal_map, "[m] frame map")->required();
  verb->add_option("--yaw", o->yaw_deg, "[degrees] heading there, from x to y (default: as now)")
      ->check(CLI::Range(-360.0, 360.0));
  add_shared(verb, *o);
  verb->footer(
      "Waits until the vehicle is there. Ctrl-C ends the wait, not the flight.\n\n"
      "Examples:\n"
      "  goshawk goto 3,8,2\n"
      "  goshawk goto 1,1,1 --yaw 90 --namespace /uav1 --timeout 30");
  verb.runs([o](const Console& console) { return pilot(*o, false, console); });
}

void add_hold(Program& program) {
  const Verb verb = program.verb(
      "hold", "give up the goal of a running flight: stop, and hover where the vehicle is now");
  auto o = std::make_shared<PilotOptions>();
  add_shared(verb, *o);
  verb->footer(
      "The point where the vehicle is becomes its goal: a plan, not an emergency stop. It brakes\n"
      "within its limits, and comes back to that point.\n\n"
      "Example:\n"
      "  goshawk hold --namespace /uav1");
  verb.runs([o](const Console& console) { return pilot(*o, true, console); });
}

}  // namespace goshawk::cli
