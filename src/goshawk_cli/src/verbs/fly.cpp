#include "flight/flight.hpp"

#include <fmt/format.h>

#include "flight/flight_summary.hpp"
#include "goshawk/introspection/interruptible.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

int run_fly(const FlyOptions& options, const Console& console) {
  const introspection::Interruptible interruptible;
  const auto preparation = prepare(options);
  if (!preparation) return console.failed(preparation.error());
  for (const std::string& note : preparation->notes) console.say(note);
  const auto summary = fly(options, *preparation, [](const std::string& sentence) {
    fmt::print(stderr, "{}\n", sentence);
  });
  if (!summary) return console.failed(summary.error());
  console.json() ? console.print(*summary) : print_summary(*summary);
  return (*summary)["ok"].get<bool>() ? kDone : kNotDone;
}

void add_goals(const Verb& verb, FlyOptions& o) {
  add_point(verb, "--start", o.start_map, "where the vehicle hovers at first (default 3,0,1)");
  add_points(verb, "--goal", o.goals_map, "[m] frame map; may repeat, for a tour (default 3,8,2)");
  verb->add_option("--random", o.random, "fly this many random reachable goals instead")
      ->check(not_negative());
  verb->add_option("--seed", o.seed, "of the random goals")
      ->capture_default_str()
      ->check(not_negative());
  verb->add_option("--min-distance", o.min_distance_m, "[m] between random goals")
      ->capture_default_str();
}

}  // namespace

void add_fly(Program& program) {
  const Verb verb = program.verb(
      "fly", "make or load a world, start every stage, send the goals, judge and draw the flight");
  auto o = std::make_shared<FlyOptions>();
  add_map_options(verb, o->map);
  add_goals(verb, *o);
  verb->add_option("--density", o->world_density, "of the made world (default 0.4)");
  verb->add_option("--world-seed", o->world_seed, "of the made world")
      ->capture_default_str()
      ->check(not_negative());
  verb->add_flag("--live", o->live,
                 "begin without a map: a simulated lidar sees the world, and the vehicle flies by "
                 "the map that it makes (launch file live)");
  auto* launch = verb->add_option("--launch", o->launch,
                                  "launch file: flight (a process each; the default), "
                                  "flight_container (one process), live, or one of your own");
  verb.completes(launch, launch_files);
  verb->add_option("--output", o->folder, "flight folder (default flights/DATE)");
  verb->add_option("--timeout", o->timeout_s, "[s] for each goal")->capture_default_str();
  verb->add_flag("--keep-going", o->keep_going, "fly to the next goal if one is not reached");
  verb->add_option("-p", o->stage_parameters, "parameter of a stage, node:name:=value; may repeat");
  verb->add_flag("--no-record{false}", o->record, "do not record the topics to flight.mcap");
  verb->footer(
      "Examples:\n"
      "  goshawk fly\n"
      "  goshawk fly --map office.bt --start 1,1,1 --goal 8,4,1.5 --goal 1,1,1\n"
      "  goshawk fly --live\n"
      "  goshawk fly --random 5 --seed 7 --launch flight_container -p simulator:wind_x_m_s:=2\n"
      "goshawk view shows the newest flight, goshawk check judges it again.");
  verb.runs([o](const Console& console) { return run_fly(*o, console); });
}

}  // namespace goshawk::cli
