#include <cstdio>
#include <filesystem>

#include "folders.hpp"
#include "goshawk/flight_report/files.hpp"
#include "goshawk/flight_report/page.hpp"
#include "planning/map_options.hpp"
#include "planning/plan_json.hpp"
#include "verbs.hpp"

namespace goshawk::cli {
namespace {

struct PlanOptions {
  MapOptions map;
  std::string start = "3,0,1";
  std::string goal = "3,8,2";
  std::vector<std::string> other_goals;
  std::string save;
  bool json = false;
};

void print(const Plan& plan) {
  for (const auto& stage : plan.stages) {
    std::printf("%-22s %-16s %9.1f us\n", stage.name.c_str(), stage.implementation.c_str(),
                stage.compute_us);
  }
  if (plan.path) {
    std::printf("path        %.3f m in %zu voxels, pruned %.3f m, %zu waypoints, %lld expanded\n",
                plan.path->raw_length_m, plan.path->raw_map.size(), plan.path->pruned_length_m,
                plan.path->waypoints_map.size(),
                static_cast<long long>(plan.path->counters.expanded));
    const std::string note = plan.path->note();
    if (!note.empty()) std::printf("            %s\n", note.c_str());
  }
  if (plan.corridor) {
    std::printf("corridor    %zu polytopes, smallest overlap %.3f m\n",
                plan.corridor->polytopes.size(), plan.corridor->min_overlap_radius_m());
  }
  if (plan.solution) {
    const auto& t = plan.solution->trajectory;
    const auto peaks = t.peaks();
    std::printf(
        "trajectory  %.3f s, %.3f m, mean %.3f m/s, top %.3f m/s and %.3f m/s^2, %zu "
        "pieces, certified\n",
        t.duration_s(), t.length_m(), t.length_m() / t.duration_s(), peaks.speed_m_s,
        peaks.acceleration_m_s2, t.pieces.size());
  }
}

Status save(const Plan& plan, const LoadedMap& map, const Limits& limits,
            const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  flight_report::Flight flight;
  VoxelGrid raw{.geometry = map.raw.geometry, .occupied = map.raw.occupied, .known = {}};
  flight.title = "Goshawk plan";
  flight.obstacles = &raw;
  flight.grown = map.grown.get();
  flight.limits = limits;
  flight_report::Leg leg;
  leg.raw_path_map = plan.path->raw_map;
  leg.waypoints_map = plan.path->waypoints_map;
  leg.corridor = plan.corridor->polytopes;
  leg.trajectory = plan.solution->trajectory;
  flight.legs.push_back(std::move(leg));
  if (auto drawn = flight_report::write_flight_folder(flight, folder); !drawn) return drawn;
  return flight_report::write_flight_page(flight, page_template(), folder + "/flight.html");
}

int run(const PlanOptions& options, const std::string& map_file) {
  const bool json = options.json;
  const auto start = parse_point(options.start);
  if (!start) return report_failure(start.error(), json, kWrongCall);
  const auto goal = parse_point(options.goal);
  if (!goal) return report_failure(goal.error(), json, kWrongCall);
  std::vector<Vec3> others;
  for (const std::string& text : options.other_goals) {
    const auto other = parse_point(text);
    if (!other) return report_failure(other.error(), json, kWrongCall);
    others.push_back(*other);
  }
  const auto limits = options.map.limits({});
  if (!limits) return report_failure(limits.error(), json, kWrongCall);
  const auto config = PlanningConfig::read(options.map.ros_args(map_file));
  if (!config) return report_failure(config.error(), json, kWrongCall);
  auto planner = Planner::create(*config);
  if (!planner) return report_failure(planner.error(), json, kWrongCall);
  const auto map = load_map(config->map);
  if (!map) return report_failure(map.error(), json, kNotDone);

  planner->set_map(*map);
  FlatState from;
  FlatState to;
  from.position = *start;
  to.position = *goal;
  const Plan plan = planner->plan(from, to, *limits, others);
  // What cannot be saved is no success: said before, and instead of, the result.
  if (plan.outcome && !options.save.empty()) {
    if (const auto saved = save(plan, *map, *limits, options.save); !saved) {
      return report_failure(saved.error(), json, kNotDone);
    }
  }
  json ? print_json(plan_to_json(plan)) : print(plan);
  if (plan.outcome) return kDone;
  return json ? kNotDone : report_failure(plan.outcome.error(), false, kNotDone);
}

}  // namespace

int plan_command(const Arguments& arguments) {
  CLI::App app("Plan once, in this process, without DDS, and print the result.", "goshawk plan");
  app.footer(
      "Examples:\n"
      "  goshawk plan\n"
      "  goshawk plan --map office.bt --start 1,1,1 --goal 8,4,1.5 --save pictures\n"
      "  goshawk plan --v-max 1 --json");
  PlanOptions options;
  options.map.add_to(app);
  app.add_option("--start", options.start, "x,y,z [m] frame map")->capture_default_str();
  app.add_option("--goal", options.goal, "x,y,z [m] frame map")->capture_default_str();
  app.add_option("--other-goal", options.other_goals,
                 "x,y,z [m] a goal that will do as well; may repeat");
  app.add_option("--save", options.save, "folder for pictures, csv and the corridor's mesh");
  app.add_flag("--json", options.json, "print one JSON object (docs/cli.md)");
  if (const auto status = parse(app, arguments)) return *status;
  if (!options.map.map.empty()) return run(options, options.map.map);
  const TemporaryFolder folder;
  const auto world = save_default_world(folder.path());
  if (!world) return report_failure(world.error(), options.json, kNotDone);
  return run(options, *world);
}

}  // namespace goshawk::cli
