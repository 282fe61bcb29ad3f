#include <functional>

#include "goshawk/corridor_builder/config.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/corridor_builder/horizon.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "goshawk/stage/map_subscription.hpp"

namespace goshawk::corridor_builder {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

/// For a map without raw voxels: the same safety, less room.
Config on_grown_grid(Config config) {
  config.margin = Margin::grown_grid;
  return config;
}

CorridorBuilder make_builder(const Config& config) {
  auto builder = CorridorBuilder::create(config);
  if (!builder) throw StartupFault(builder.error());
  return *std::move(builder);
}

/// path -> corridor
class CorridorBuilderComponent : public Component {
 public:
  explicit CorridorBuilderComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) { return reconfigure(c); })),
        builder_(make_builder(config_)),
        fallback_(make_builder(on_grown_grid(config_))),
        reporter_(node, StageRole::corridor_builder, std::string(builder_.implementation())),
        publisher_(node.advertise<msg::Corridor>("corridor", Qos::reliable_last())),
        map_(node, reporter_),
        paths_(node, reporter_, "path", std::bind_front(&CorridorBuilderComponent::on_path, this)) {
    reporter_.ready("builds corridors with " + std::string(builder_.implementation()));
  }

 private:
  Status reconfigure(const Config& config) {
    if (auto status = builder_.reconfigure(config); !status) return status;
    if (auto status = fallback_.reconfigure(on_grown_grid(config)); !status) return status;
    reporter_.set_implementation(std::string(builder_.implementation()));
    horizon_m_ = config.horizon_m;
    return success();
  }

  bool lacks_raw() const { return config_.margin == Margin::sphere && map_.grid()->raw.empty(); }

  Result<Corridor> build(std::span<const Vec3> waypoints) {
    return (lacks_raw() ? fallback_ : builder_).build(*map_.grid(), waypoints);
  }

  void on_path(const msg::Path& m, const PlanRequest& request, Timing timing) {
    if (auto status = check_map(m); !status) {
      return reporter_.failed(request.id, status.error(), timing);
    }
    const auto waypoints = conversions::waypoints_of(m);
    if (!waypoints) return reporter_.failed(request.id, waypoints.error(), timing);
    const FirstPart part = within_horizon(*waypoints, horizon_m_);
    auto [corridor, compute_ns] = timed([&] { return build(part.waypoints_map); });
    timing.compute_ns = compute_ns;
    if (!corridor) return reporter_.failed(request.id, corridor.error(), timing);
    auto answered = m.request();
    if (part.beyond_m > 0.0) {
      answered.goal().position(conversions::to_point(part.waypoints_map.back()));
    }
    // First the report: the navigator must know how far the plan ends from the goal.
    report(request.id, *corridor, part.beyond_m, timing);
    publish(answered, *corridor, compute_ns);
  }

  Status check_map(const msg::Path& m) const {
    if (map_.grid() == nullptr) {
      return fail(ErrorCode::no_map,
                  "no map has come yet on map/voxels: is the map server running?");
    }
    if (map_.grid()->version >= m.map_version()) return success();
    return fail(ErrorCode::no_map, "the path was searched in map version " +
                                       std::to_string(m.map_version()) + ", but version " +
                                       std::to_string(map_.grid()->version) +
                                       " is the newest here: ask again");
  }

  void publish(const msg::PlanRequest& request, const Corridor& corridor, std::int64_t compute_ns) {
    msg::Corridor m;
    m.request(request);
    m.implementation(std::string(builder_.implementation()));
    m.map_version(map_.grid()->version);
    m.waypoints(conversions::to_points(corridor.waypoints_map));
    m.polytopes(conversions::to_msg(corridor.polytopes));
    m.min_overlap_radius(corridor.min_overlap_radius_m());
    m.compute_ns(compute_ns);
    m.header(conversions::make_header(node_.now_ns()));
    reporter_.send(publisher_, m, request.id());
  }

  void report(std::uint64_t id, const Corridor& corridor, double beyond_m, const Timing& timing) {
    double faces = 0;
    for (const auto& polytope : corridor.polytopes) faces += polytope.faces();
    reporter_.answered(id, timing,
                       {{"polytopes", double(corridor.polytopes.size())},
                        {"faces", faces},
                        {"beyond_m", beyond_m},
                        {"min_overlap_radius_m", corridor.min_overlap_radius_m()}},
                       lacks_raw() ? "margin grown_grid: the map brings no raw voxels, set "
                                     "publish_raw of map_server"
                                   : "");
  }

  Node& node_;
  const Config config_;  // as it was at start
  double horizon_m_ = config_.horizon_m;
  CorridorBuilder builder_;
  CorridorBuilder fallback_;  // margin grown_grid
  StageReporter reporter_;
  Publisher<msg::Corridor> publisher_;
  MapSubscription map_;
  Intake<msg::Path> paths_;
};

}  // namespace
}  // namespace goshawk::corridor_builder

GOSHAWK_REGISTER_COMPONENT(goshawk::corridor_builder::CorridorBuilderComponent,
                           goshawk::corridor_builder::Config)
