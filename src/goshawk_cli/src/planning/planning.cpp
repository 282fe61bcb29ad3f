#include "planning/planning.hpp"

#include "goshawk/map_server/map_file.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"

namespace goshawk::cli {
namespace {

template <typename Config>
Status read_into(Config& config, const runtime::RosArgs& args, const char* node) {
  const auto source = args.parameters_of(node);
  if (!source) return source.error();
  auto read = runtime::read_parameters<Config>(*source, node);
  if (!read) return read.error();
  config = *std::move(read);
  return success();
}

// Runs one stage, notes its time, and hands its answer on.
template <typename Work>
auto run_stage(Plan& plan, std::string name, std::string implementation, Work&& work) {
  auto [result, ns] = stage::timed(std::forward<Work>(work));
  plan.stages.push_back({std::move(name), std::move(implementation), double(ns) * 1e-3});
  return std::move(result);
}

Result<map_server::MapSource> made_map(const worlds::WorldSpec& spec) {
  auto world = worlds::make_world(spec);
  if (!world) return world.error();
  map_server::MapSource source;
  const Index3 size = world->geometry.size;
  source.voxels = map_server::RawVoxels{world->geometry, std::move(world->occupied),
                                        BitGrid(size, false, true)};
  return source;
}

}  // namespace

Result<PlanningConfig> PlanningConfig::read(const runtime::RosArgs& args) {
  PlanningConfig c;
  std::string faults;
  const auto note = [&](const Status& status) {
    if (!status) faults += (faults.empty() ? "" : "\n") + status.error().message;
  };
  for (const auto& file : args.params_files) {
    note(runtime::check_sections(file, runtime::installed_components()));
  }
  if (!faults.empty()) return fail(ErrorCode::invalid_parameter, faults);
  note(read_into(c.map, args, "map_server"));
  note(read_into(c.search, args, "path_search"));
  note(read_into(c.corridor, args, "corridor_builder"));
  note(read_into(c.trajectory, args, "trajectory_optimizer"));
  if (!faults.empty()) return fail(ErrorCode::invalid_parameter, faults);
  return c;
}

Result<LoadedMap> load_map(const PlanningConfig& config, const worlds::WorldSpec& world) {
  auto source = config.needs_world()
                    ? made_map(world)
                    : map_server::load_map(config.map.map_file, map_server::load_options(config.map));
  if (!source) return source.error();
  auto raw = map_server::voxelize(*source, map_server::voxelize_options(config.map));
  if (!raw) return raw.error();
  auto grown = map_server::make_voxel_grid(*raw, map_server::growth(config.map), 1);
  if (!grown) return grown.error();
  return LoadedMap{*std::move(raw), std::make_shared<const VoxelGrid>(*std::move(grown)),
                   std::move(source->notes)};
}

Result<Planner> Planner::create(const PlanningConfig& config) {
  auto search = path_search::PathSearch::create(config.search);
  if (!search) return search.error();
  auto builder = corridor_builder::CorridorBuilder::create(config.corridor);
  if (!builder) return builder.error();
  auto optimizer = trajectory_optimizer::TrajectoryOptimizer::create(config.trajectory);
  if (!optimizer) return optimizer.error();
  return Planner(*std::move(search), *std::move(builder), *std::move(optimizer));
}

void Planner::set_map(const LoadedMap& map) {
  grid_ = map.grown;
  search_.set_map(grid_);
}

Plan Planner::plan(const PlanRequest& request) {
  Plan plan;
  plan.request = request;
  plan.outcome = run(plan);
  return plan;
}

Status Planner::run(Plan& plan) {
  PlanRequest& request = plan.request;
  if (auto status = check(request); !status) return status;
  auto path = run_stage(plan, "path_search", std::string(search_.planner_name()),
                        [&] { return search_.plan(request); });
  if (!path) return path.error();
  plan.path = *std::move(path);
  // The search may have moved the ends, or chosen another goal.
  request.start.position = plan.path->waypoints_map.front();
  request.goal.position = plan.path->waypoints_map.back();
  auto corridor = run_stage(plan, "corridor_builder", std::string(builder_.implementation()),
                            [&] { return builder_.build(*grid_, plan.path->waypoints_map); });
  if (!corridor) return corridor.error();
  plan.corridor = *std::move(corridor);
  auto solution = run_stage(plan, "trajectory_optimizer", std::string(optimizer_.implementation()),
                            [&] { return optimizer_.optimise(request, *plan.corridor); });
  if (!solution) return solution.error();
  plan.solution = *std::move(solution);
  return success();
}

}  // namespace goshawk::cli
