// hold, resume, land and takeoff.

#include <fmt/format.h>

#include <algorithm>

#include "flight/mission_watch.hpp"
#include "flight/operator_client.hpp"
#include "flight/pilot.hpp"
#include "json.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

namespace verb_of = goshawk_msgs::msg::OperatorCommand_Constants;
namespace mission_state = goshawk_msgs::msg::MissionState_Constants;

/// A flight that runs, with what the operator's verbs need of it.
struct RunningFlight {
  std::unique_ptr<introspection::Session> session;
  std::string space;
  std::unique_ptr<OperatorClient> client;
  std::unique_ptr<Pilot> pilot;
};

Result<RunningFlight> open_flight(const VehicleOptions& o, const Console& console) {
  const auto space = introspection::full_topic_name(o.space);
  if (!space) return space.error();
  auto session = introspection::Session::open();
  if (!session) return session.error();
  RunningFlight flight{.session = *std::move(session), .space = *space, .client = {}, .pilot = {}};
  flight.client = std::make_unique<OperatorClient>(*flight.session, *space);
  flight.pilot = std::make_unique<Pilot>(
      *flight.session, *space, [&console](const std::string& sentence) { console.say(sentence); });
  return flight;
}

int tell(const std::string& sentence, const Vec3& place_map, const Console& console) {
  if (console.json()) {
    Json object = ok_json();
    object["message"] = sentence;
    object["position"] = to_json(place_map);
    console.print(object);
  } else {
    fmt::print("{}\n", sentence);
  }
  return kDone;
}

// Sent at once: nothing is waited for that a stop does not need.
int hold(const VehicleOptions& o, const Console& console) {
  auto flight = open_flight(o, console);
  if (!flight) return console.failed(flight.error());
  const auto answer = flight->client->command(verb_of::VERB_HOLD, 0.0, o.ready_s);
  if (!answer) return console.failed(answer.error());
  Pilot& pilot = *flight->pilot;
  if (auto status = pilot.wait_ready(o.ready_s); !status) return console.failed(status.error());
  pilot.forget_answers();
  if (auto status = pilot.rest(o.timeout_s); !status) return console.not_done(status.error());
  return tell("holds at " + to_text(pilot.position_map()), pilot.position_map(), console);
}

/// Land and take off: the stage's sentence, then the way there.
int climb_or_descend(const VehicleOptions& o, std::uint8_t verb, double height_m,
                     const Console& console) {
  auto flight = open_flight(o, console);
  if (!flight) return console.failed(flight.error());
  Pilot& pilot = *flight->pilot;
  if (auto status = pilot.wait_ready(o.ready_s); !status) return console.failed(status.error());
  pilot.forget_answers();
  const auto answer = flight->client->command(verb, height_m, o.ready_s);
  if (!answer) return console.failed(answer.error());
  console.say(*answer);
  const auto arrival = pilot.arrive({}, o.timeout_s);
  if (!arrival) return console.not_done(arrival.error());
  return tell(fmt::format("rests at {}", to_text(pilot.position_map())), pilot.position_map(),
              console);
}

/// Whether a mission waits for somebody to resume it.
bool mission_waits(const RunningFlight& flight, MissionWatch& watch) {
  const bool has_stage =
      std::ranges::any_of(flight.session->endpoints_of(topic_in(flight.space, "mission_state")),
                          [](const auto& endpoint) { return endpoint.writer; });
  const auto state = watch.newest(has_stage ? 5.0 : 0.5);
  return state && (state->state() == mission_state::STATE_PAUSED ||
                   state->state() == mission_state::STATE_FAILED);
}

int resume(const VehicleOptions& o, const Console& console) {
  auto flight = open_flight(o, console);
  if (!flight) return console.failed(flight.error());
  Pilot& pilot = *flight->pilot;
  if (auto status = pilot.wait_ready(o.ready_s); !status) return console.failed(status.error());
  MissionWatch watch(*flight->session, flight->space);  // hears missions until this verb ends
  const std::uint8_t verb =
      mission_waits(*flight, watch) ? verb_of::VERB_RESUME_MISSION : verb_of::VERB_RESUME;
  const auto answer = flight->client->command(verb, 0.0, o.ready_s);
  if (!answer) return console.failed(answer.error());
  return tell(*answer, pilot.position_map(), console);
}

}  // namespace

void add_hold(Program& program) {
  const Verb verb = program.verb("hold",
                                 "stop the vehicle of a running flight, as gently as its "
                                 "limits allow");
  auto o = std::make_shared<VehicleOptions>();
  add_vehicle_options(verb, *o);
  verb->footer(
      "The vehicle brakes on the path that it flies: a stop needs no plan. Its goal, or its\n"
      "mission, waits for goshawk resume. Ctrl-C ends the wait, not the hold.\n\n"
      "Example:\n"
      "  goshawk hold --namespace /uav1");
  verb.runs([o](const Console& console) { return hold(*o, console); });
}

void add_resume(Program& program) {
  const Verb verb = program.verb(
      "resume", "fly on: the mission that is paused or has failed, or the goal that was held");
  auto o = std::make_shared<VehicleOptions>();
  add_vehicle_options(verb, *o);
  verb->footer(
      "Does not wait for the vehicle (goshawk mission watches a mission).\n\n"
      "Example:\n"
      "  goshawk resume");
  verb.runs([o](const Console& console) { return resume(*o, console); });
}

void add_land(Program& program) {
  const Verb verb =
      program.verb("land", "stop, and descend as far as the map shows free below the vehicle");
  auto o = std::make_shared<VehicleOptions>();
  add_vehicle_options(verb, *o);
  verb->footer(
      "The vehicle rests above the ground by its radius and margin, and its motors keep running:\n"
      "Goshawk neither touches down nor disarms. Below space that was never seen it does not\n"
      "descend.\n\n"
      "Example:\n"
      "  goshawk land");
  verb.runs([o](const Console& console) {
    return climb_or_descend(*o, verb_of::VERB_LAND, 0.0, console);
  });
}

void add_takeoff(Program& program) {
  const Verb verb = program.verb("takeoff", "climb straight up from where the vehicle is");
  auto o = std::make_shared<VehicleOptions>();
  auto height_m = std::make_shared<double>(1.0);
  verb->add_option("--height", *height_m, "[m] how far")
      ->check(CLI::Range(0.01, 10000.0))
      ->capture_default_str();
  add_vehicle_options(verb, *o);
  verb->footer(
      "The motors of a simulated vehicle always run; an autopilot must be armed by its own "
      "tool.\n\n"
      "Example:\n"
      "  goshawk takeoff --height 2");
  verb.runs([o, height_m](const Console& console) {
    return climb_or_descend(*o, verb_of::VERB_TAKEOFF, *height_m, console);
  });
}

}  // namespace goshawk::cli
