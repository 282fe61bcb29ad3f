#include <filesystem>
#include <set>

#include "goshawk/introspection/schema.hpp"
#include "goshawk/introspection/session.hpp"
#include "goshawk/runtime/component.hpp"
#include "process.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

constexpr double kCompletion_s = 1.0;  // who presses a key does not wait longer

}  // namespace

void add_map_options(const Verb& verb, MapOptions& o) {
  verb->add_option("--map", o.map,
                   "map file: .bt, .ot, .pcd, .ply, .stl, .obj, .3dmap (default: a made world)");
  auto* unknown = verb->add_option("--unknown", o.unknown,
                                   "space never measured: occupied (default), blocked, free");
  verb.completes(unknown, [](const Words&) { return Words{"occupied", "blocked", "free"}; });
  verb->add_option("--v-max", o.v_max_m_s, "[m/s] speed limit (default 2)");
  verb->add_option("--a-max", o.a_max_m_s2, "[m/s^2] acceleration limit (default 2)");
  verb.choice("--norm", o.norm,
              "what the limits bound: euclidean (default), per_axis or horizontal_vertical",
              all_words<LimitNorm>());
  verb->add_option("--v-max-vertical", o.v_max_vertical_m_s,
                   "[m/s] vertical speed limit, with --norm horizontal_vertical (default --v-max)");
  verb->add_option("--a-max-vertical", o.a_max_vertical_m_s2,
                   "[m/s^2] vertical acceleration limit, with --norm horizontal_vertical (default "
                   "--a-max)");
  verb->add_option("--j-max", o.j_max_m_s3, "[m/s^3] limit of the jerk (default: none)");
  verb->add_option("--radius", o.radius, "[m] radius of the vehicle (default 0.15)");
  verb->add_option("--margin", o.margin, "[m] kept for the tracking error (default 0.05)");
  verb->add_option("--resolution", o.resolution,
                   "[m] voxel edge for clouds, meshes and .3dmap (default 0.2)");
  verb->add_option("--params-file", o.params_files, "file of parameters as in ROS 2; may repeat");
}

void add_vehicle_options(const Verb& verb, VehicleOptions& o) {
  verb->add_option("--namespace", o.space, "of the vehicle, as /uav1")->capture_default_str();
  verb->add_option("--timeout", o.timeout_s, "[s] longest wait for the vehicle")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  verb->add_option("--ready", o.ready_s, "[s] longest wait for the flight to be found")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
}

Words component_names(const Words&) {
  return runtime::installed_components();
}

Words launch_files(const Words&) {
  std::set<std::string> names;
  std::error_code ignored;
  const auto folder = install_prefix() + "/share/goshawk/launch";
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    names.insert(entry.path().stem().string());
  }
  return {names.begin(), names.end()};
}

Words topic_names(const Words&) {
  std::set<std::string> names;
  if (auto session = introspection::Session::open()) {
    (*session)->settle(kCompletion_s);
    for (const auto& e : (*session)->context().endpoints()) {
      if (e.topic.starts_with('/')) names.insert(e.topic);
    }
  }
  return {names.begin(), names.end()};
}

Words type_names(const Words&) {
  Words names;
  for (const auto& type : introspection::all_types()) names.emplace_back(type.name);
  return names;
}

Words node_names(const Words&) {
  std::set<std::string> names;
  if (auto session = introspection::Session::open()) {
    (*session)->settle(kCompletion_s);
    for (const auto& p : (*session)->context().participants()) {
      names.insert(p.nodes.begin(), p.nodes.end());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace goshawk::cli
