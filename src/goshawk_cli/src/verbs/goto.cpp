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
  VehicleOptions vehicle;
};

int tell(const Arrival& arrival, const Console& console) {
  if (console.json()) {
    Json object = ok_json();
    object.update({{"goal", to_json(arrival.goal_map)},
                   {"distance_m", arrival.distance_m},
                   {"time_s", arrival.time_s}});
    console.print(object);
  } else {
    fmt::print("arrived at {} after {:.1f} s, {:.3f} m from it\n", to_text(arrival.goal_map),
               arrival.time_s, arrival.distance_m);
  }
  return kDone;
}

int go(const PilotOptions& o, const Console& console) {
  const auto space = introspection::full_topic_name(o.vehicle.space);
  if (!space) return console.failed(space.error());
  auto session = introspection::Session::open();
  if (!session) return console.failed(session.error());
  Pilot pilot(**session, *space, [&](const std::string& sentence) { console.say(sentence); });
  if (auto status = pilot.wait_ready(o.vehicle.ready_s); !status)
    return console.failed(status.error());
  std::optional<double> yaw_rad;
  if (o.yaw_deg) yaw_rad = *o.yaw_deg * kDegree_rad;
  const auto arrival = pilot.go(o.goal_map, yaw_rad, o.vehicle.timeout_s);
  if (!arrival) return console.not_done(arrival.error());
  return tell(*arrival, console);
}

}  // namespace

void add_goto(Program& program) {
  const Verb verb = program.verb("goto", "send the vehicle of a running flight to a point");
  auto o = std::make_shared<PilotOptions>();
  add_point(verb, "goal", o->goal_map, "[m] frame map")->required();
  verb->add_option("--yaw", o->yaw_deg, "[degrees] heading there, from x to y (default: as now)")
      ->check(CLI::Range(-360.0, 360.0));
  add_vehicle_options(verb, o->vehicle);
  verb->footer(
      "Waits until the vehicle is there. Ctrl-C ends the wait, not the flight.\n\n"
      "Examples:\n"
      "  goshawk goto 3,8,2\n"
      "  goshawk goto 1,1,1 --yaw 90 --namespace /uav1 --timeout 30");
  verb.runs([o](const Console& console) { return go(*o, console); });
}

}  // namespace goshawk::cli
