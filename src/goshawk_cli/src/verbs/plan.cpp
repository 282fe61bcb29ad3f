#include <fmt/format.h>

#include <filesystem>

#include "goshawk/flight_report/files.hpp"
#include "goshawk/flight_report/page.hpp"
#include "planning/plan_json.hpp"
#include "process.hpp"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

struct PlanOptions {
  PlanOptions() {
    request.start.position = Vec3(3.0, 0.0, 1.0);
    request.goal.position = Vec3(3.0, 8.0, 2.0);
  }
  MapOptions map;
  PlanRequest request;
  std::string save;
};

void print(const Plan& plan) {
  for (const auto& stage : plan.stages) {
    fmt::print("{:<22} {:<16} {:9.1f} us\n", stage.name, stage.implementation, stage.compute_us);
  }
  if (plan.path) {
    fmt::print("path        {:.3f} m in {} voxels, pruned {:.3f} m, {} waypoints, {} expanded\n",
               plan.path->raw_length_m, plan.path->raw_map.size(), plan.path->pruned_length_m,
               plan.path->waypoints_map.size(), plan.path->counters.expanded);
    const std::string note = plan.path->note();
    if (!note.empty()) fmt::print("            {}\n", note);
  }
  if (plan.corridor) {
    fmt::print("corridor    {} polytopes, smallest overlap {:.3f} m\n",
               plan.corridor->polytopes.size(), plan.corridor->min_overlap_radius_m());
  }
  if (plan.solution) {
    const auto& t = plan.solution->trajectory();
    const auto peaks = t.peaks();
    fmt::print(
        "trajectory  {:.3f} s, {:.3f} m, mean {:.3f} m/s, top {:.3f} m/s and {:.3f} m/s^2, {} "
        "pieces, certified\n",
        t.duration_s(), t.length_m(), t.length_m() / t.duration_s(), peaks.speed_m_s,
        peaks.acceleration_m_s2, t.pieces.size());
  }
}

Status save(const Plan& plan, const LoadedMap& map, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  flight_report::Flight flight;
  VoxelGrid raw{.geometry = map.raw.geometry, .grown = map.raw.occupied, .known = {}};
  flight.title = "Goshawk plan";
  flight.obstacles = &raw;
  flight.grown = map.grown.get();
  flight.limits = plan.request.limits;
  flight_report::Leg leg;
  leg.raw_path_map = plan.path->raw_map;
  leg.waypoints_map = plan.path->waypoints_map;
  leg.corridor = plan.corridor->polytopes;
  leg.trajectory = plan.solution->trajectory();
  flight.legs.push_back(std::move(leg));
  if (auto drawn = flight_report::write_flight_folder(flight, folder); !drawn) return drawn;
  return flight_report::write_flight_page(flight, page_template(), folder + "/flight.html");
}

int run_plan(const PlanOptions& o, const Console& console) {
  const auto config = PlanningConfig::read(o.map.ros_args());
  if (!config) return console.wrong_call(config.error());
  auto planner = Planner::create(*config);
  if (!planner) return console.wrong_call(planner.error());
  const auto map = load_map(*config);
  if (!map) return console.not_done(map.error());
  for (const std::string& note : map->notes) console.say("map: " + note);

  planner->set_map(*map);
  PlanRequest request = o.request;
  request.limits = o.map.limits();
  const Plan plan = planner->plan(request);
  // A plan that cannot be saved is a failure: it is told instead of the result.
  if (plan.outcome && !o.save.empty()) {
    if (const auto saved = save(plan, *map, o.save); !saved) {
      return console.not_done(saved.error());
    }
  }
  console.json() ? console.print(plan_to_json(plan)) : print(plan);
  if (plan.outcome) return kDone;
  return console.json() ? kNotDone : console.not_done(plan.outcome.error());
}

}  // namespace

void add_plan(Program& program) {
  const Verb verb = program.verb(
      "plan", "one plan in this process, no DDS: path, corridor, certified trajectory");
  auto o = std::make_shared<PlanOptions>();
  add_map_options(verb, o->map);
  add_point(verb, "--start", o->request.start.position, "[m] frame map");
  add_point(verb, "--goal", o->request.goal.position, "[m] frame map");
  add_points(verb, "--other-goal", o->request.other_goals_map,
             "[m] another goal that will do as well; may repeat");
  verb->add_option("--save", o->save, "folder for pictures, tables and the corridor's mesh");
  verb->footer(
      "Examples:\n"
      "  goshawk plan\n"
      "  goshawk plan --map office.bt --start 1,1,1 --goal 8,4,1.5 --save pictures\n"
      "  goshawk plan --v-max 1 --json");
  verb.runs([o](const Console& console) { return run_plan(*o, console); });
}

}  // namespace goshawk::cli
