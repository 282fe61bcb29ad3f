#include "goshawk/conformance/conform.hpp"

#include "examiner.hpp"
#include "goshawk/runtime/parameters.hpp"

namespace goshawk::conformance {

bool Report::passed() const {
  return !items.empty() && std::ranges::all_of(items, &Item::passed);
}

std::vector<std::string> stages() {
  return {"path_search", "corridor_builder", "trajectory_optimizer"};
}

Result<Report> conform(runtime::Context& context, const Options& o) {
  const World world = make_world(o.seed);
  Random random(o.seed + 1);
  if (o.stage == "path_search") {
    Examiner<msg::PlanRequest, msg::Path> examiner(context, o, "plan_request", "path", world);
    return examiner.examine(search_cases(world, random, o.requests));
  }
  if (o.stage == "corridor_builder") {
    Examiner<msg::Path, msg::Corridor> examiner(context, o, "path", "corridor", world);
    return examiner.examine(corridor_cases(world, random, o.requests));
  }
  if (o.stage == "trajectory_optimizer") {
    Examiner<msg::Corridor, msg::BezierTrajectory> examiner(context, o, "corridor", "trajectory",
                                                            world);
    return examiner.examine(trajectory_cases(world, random, o.requests));
  }
  const std::string near = runtime::nearest_name(o.stage, stages());
  return fail(ErrorCode::invalid_parameter,
              "there is no conformance kit for '" + o.stage + "'" +
                  (near.empty() ? ": path_search, corridor_builder and trajectory_optimizer have one"
                                : "; did you mean " + near + "?"));
}

}  // namespace goshawk::conformance
