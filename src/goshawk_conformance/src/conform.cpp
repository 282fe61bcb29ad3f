#include "goshawk/conformance/conform.hpp"

#include <cmath>

#include "examiner.hpp"
#include "goshawk/runtime/parameters.hpp"
#include "map_examiner.hpp"
#include "tracker_examiner.hpp"

namespace goshawk::conformance {

bool Report::passed() const {
  return !items.empty() && std::ranges::all_of(items, &Item::passed);
}

std::vector<std::string> stages() {
  return {"path_search", "corridor_builder", "trajectory_optimizer", "tracker", "map_server"};
}

namespace {

template <typename Input, typename Output, typename MakeCases>
Result<Report> examine(runtime::Context& context, const Options& o, const char* input_topic,
                       const char* output_topic, const MakeCases& make_cases) {
  std::optional<Recorded<Input>> recorded;
  if (!o.input.empty()) {
    auto loaded = load_recorded<Input, Output>(o.input, input_topic, output_topic);
    if (!loaded) return loaded.error();
    recorded = *std::move(loaded);
  }
  const World world = make_world(o.seed);
  Random random(o.seed + 1);
  Examiner<Input, Output> examiner(context, o, input_topic, output_topic, world);
  return examiner.examine(make_cases(world, random, o.requests), recorded);
}

/// @return the messages of a recording's topic; invalid_input if it has none
template <typename Message>
Result<std::vector<Message>> load(const Options& o, const std::string& topic) {
  if (o.input.empty()) return std::vector<Message>{};
  auto reader = recording::Reader::open(o.input);
  if (!reader) return reader.error();
  return recording::messages_of<Message>(*reader, topic);
}

Result<Report> examine_tracker(runtime::Context& context, const Options& o) {
  auto flights = load<msg::CommittedTrajectory>(o, "committed_trajectory");
  if (!flights) return flights.error();
  // Trajectories that begin in motion cannot be flown from rest.
  std::erase_if(*flights, [](const msg::CommittedTrajectory& m) {
    const auto& v = m.nominal().request().start().velocity();
    return m.nominal().pieces().empty() || std::hypot(v.x(), v.y(), v.z()) > 1e-3;
  });
  return TrackerExaminer(context, o).examine(*flights);
}

Result<Report> examine_map_server(runtime::Context& context, const Options& o) {
  const auto clouds = load<sensor_msgs::msg::PointCloud2>(o, "cloud_in");
  if (!clouds) return clouds.error();
  return MapExaminer(context, o).examine(*clouds);
}

}  // namespace

Result<Report> conform(runtime::Context& context, const Options& o) {
  if (o.stage == "path_search") {
    return examine<msg::PlanRequest, msg::Path>(context, o, "plan_request", "path", search_cases);
  }
  if (o.stage == "corridor_builder") {
    return examine<msg::Path, msg::Corridor>(context, o, "path", "corridor", corridor_cases);
  }
  if (o.stage == "trajectory_optimizer") {
    return examine<msg::Corridor, msg::BezierTrajectory>(context, o, "corridor", "trajectory",
                                                         trajectory_cases);
  }
  if (o.stage == "tracker") return examine_tracker(context, o);
  if (o.stage == "map_server") return examine_map_server(context, o);
  const std::string near = runtime::nearest_name(o.stage, stages());
  return fail(
      ErrorCode::invalid_parameter,
      "there is no conformance kit for '" + o.stage + "'" +
          (near.empty() ? ": path_search, corridor_builder, trajectory_optimizer, tracker and "
                          "map_server have one"
                        : "; did you mean " + near + "?"));
}

}  // namespace goshawk::conformance
