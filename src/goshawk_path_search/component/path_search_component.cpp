#include <fmt/format.h>

#include <functional>

#include "goshawk/path_search/config.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "goshawk/stage/map_subscription.hpp"

namespace goshawk::path_search {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

PathSearch make_search(const Config& config) {
  auto search = PathSearch::create(config);
  if (!search) throw StartupFault(search.error());
  return *std::move(search);
}

/// plan_request -> path
class PathSearchComponent : public Component {
 public:
  explicit PathSearchComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) { return reconfigure(c); })),
        search_(make_search(config_)),
        reporter_(node, StageRole::path_search, std::string(search_.planner_name())),
        publisher_(node.advertise<msg::Path>("path", Qos::reliable_last())),
        map_(node, reporter_, [this](const auto& grid) { search_.set_map(grid); }),
        requests_(node, reporter_, "plan_request",
                  std::bind_front(&PathSearchComponent::on_request, this)) {
    reporter_.ready(
        fmt::format("searches with {}, {}", search_.planner_name(), to_word(config_.corner_rule)));
  }

 private:
  Status reconfigure(const Config& config) {
    if (auto status = search_.reconfigure(config); !status) return status;
    config_ = config;
    reporter_.set_implementation(std::string(search_.planner_name()));
    return success();
  }

  void on_request(const msg::PlanRequest& m, const PlanRequest& request, Timing timing) {
    auto [path, compute_ns] = timed([&] { return search_.plan(request, stop_of(request)); });
    timing.compute_ns = compute_ns;
    if (!path) return reporter_.failed(request.id, path.error(), timing);
    publish(m, *path, compute_ns);
    report(request.id, *path, timing);
  }

  /// What is left of the request's deadline.
  StopSignal stop_of(const PlanRequest& request) const {
    if (request.deadline_s == 0.0) return {};
    const double age_s = double(node_.monotonic_ns() - request.stamp_ns) * 1e-9;
    return StopSignal::after(request.deadline_s - age_s);
  }

  void report(std::uint64_t request_id, const PlannedPath& path, Timing timing) {
    reporter_.set_implementation(path.implementation);
    reporter_.answered(request_id, timing,
                       {{"expanded", double(path.counters.expanded)},
                        {"generated", double(path.counters.generated)},
                        {"raw_length_m", path.raw_length_m},
                        {"pruned_length_m", path.pruned_length_m},
                        {"waypoints_raw", double(path.raw_map.size())},
                        {"waypoints", double(path.waypoints_map.size())},
                        {"goal", double(path.goal)},
                        {"start_moved_m", path.start_moved_m},
                        {"goal_moved_m", path.goal_moved_m}},
                       path.note());
  }

  void publish(const msg::PlanRequest& request, const PlannedPath& path, std::int64_t compute_ns) {
    msg::Path m;
    m.request(request);
    // The stages behind this one begin and end where the path does: at the start as it was moved
    // (which a vehicle that is elsewhere will not fly), and at the goal that was reached.
    if (path.start_moved_m > 0.0) {
      m.request().start().position(conversions::to_point(path.waypoints_map.front()));
    }
    m.request().goal().position(conversions::to_point(path.waypoints_map.back()));
    m.implementation(path.implementation);
    m.map_version(map_.grid()->version);
    m.raw(conversions::to_points(path.raw_map));
    m.waypoints(conversions::to_points(path.waypoints_map));
    m.raw_length(path.raw_length_m);
    m.length(path.pruned_length_m);
    m.cost(path.cost);
    m.expanded(std::uint64_t(path.counters.expanded));
    m.compute_ns(compute_ns);
    m.header(conversions::make_header(node_.now_ns()));
    reporter_.send(publisher_, m, request.id());
  }

  Node& node_;
  Config config_;
  PathSearch search_;
  StageReporter reporter_;
  Publisher<msg::Path> publisher_;
  MapSubscription map_;
  Intake<msg::PlanRequest> requests_;
};

}  // namespace
}  // namespace goshawk::path_search

GOSHAWK_REGISTER_COMPONENT(goshawk::path_search::PathSearchComponent, goshawk::path_search::Config)
