#include "bench/plan_rig.hpp"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "goshawk/map_server/octree.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "process.hpp"

namespace goshawk::cli {
namespace {

constexpr int kMostFailures = 10;  // the map may not be there for the first plans
constexpr double kStagesReady_s = 30.0;
constexpr double kPlan_s = 2.0;
constexpr int kParentAt = 1, kUserTimeAt = 11;  // words after the name in /proc/PID/stat

/// The map server's parameters, and a made world if they name no map.
Result<std::vector<std::string>> launch_arguments(const PlanRigOptions& o,
                                                  const std::string& folder) {
  auto args = o.map.ros_args();
  const auto config = PlanningConfig::read(args);
  if (!config) return config.error();
  if (config->needs_world()) {
    const auto map = load_map(*config);
    if (!map) return map.error();
    args.overrides.push_back({"map_server", "map_file", folder + "/world.bt"});
    if (auto saved = map_server::save_voxels(map->raw.geometry, map->raw.occupied, map->raw.known,
                                             args.overrides.back().value);
        !saved) {
      return saved.error();
    }
  }
  std::vector<std::string> arguments{o.launch, "--log-dir", folder};
  if (!o.secure.empty()) arguments.insert(arguments.end(), {"--secure", o.secure});
  // Stages take requests from one process alone: this one, not the navigator.
  arguments.insert(arguments.end(),
                   {"--ros-args", "-r", "navigator:plan_request:=bench/unheard_requests"});
  for (const auto& file : args.params_files) {
    arguments.insert(arguments.end(), {"--params-file", file});
  }
  for (const auto& p : args.overrides) {
    arguments.insert(arguments.end(), {"-p", p.node + ":" + p.name + ":=" + p.value});
  }
  return arguments;
}

/// This process speaks with the certificate of `benchmark`. The launch gives each stage its own.
Status take_certificate(const std::string& keys) {
  const auto profile = std::filesystem::absolute(keys) / "benchmark" / "profile.xml";
  if (!std::filesystem::exists(profile)) {
    return fail(ErrorCode::io_failed,
                fmt::format("{} is missing: make the folder anew with goshawk secure init {}",
                            profile.string(), keys));
  }
  setenv("FASTRTPS_DEFAULT_PROFILES_FILE", profile.c_str(), 1);
  return success();
}

/// Words of /proc/PID/stat after the program's name, which may hold spaces.
std::vector<std::string> words_of(const std::filesystem::path& process) {
  std::ifstream file(process / "stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  std::istringstream rest(text.substr(std::min(text.size(), text.rfind(')') + 1)));
  return {std::istream_iterator<std::string>(rest), {}};
}

}  // namespace

Result<std::unique_ptr<PlanRig>> PlanRig::start(const PlanRigOptions& o) {
  if (!o.secure.empty()) {
    if (auto status = take_certificate(o.secure); !status) return status.error();
  }
  const auto domain = o.secure.empty() ? private_domain() : runtime::hold_private_domain();
  if (!domain) return domain.error();
  const auto folder = make_log_folder("bench_plan");
  if (!folder) return folder.error();
  const auto arguments = launch_arguments(o, *folder);
  if (!arguments) return arguments.error();
  std::unique_ptr<PlanRig> rig(new PlanRig());
  if (auto status = rig->join(o, *domain); !status) return status.error();
  auto launch = start_launch(*arguments, *domain, *folder + "/launch.log");
  if (!launch) return launch.error();
  rig->launch_.emplace(*std::move(launch));
  if (auto status = rig->wait_until_ready(*folder); !status) return status.error();
  return rig;
}

Status PlanRig::join(const PlanRigOptions& o, int domain) {
  auto options = runtime::ContextOptions::from_environment();
  if (!options) return options.error();
  options->domain = domain;
  auto context = runtime::Context::create(*options);
  if (!context) return context.error();
  context_ = *std::move(context);
  node_ = std::make_unique<runtime::Node>(*context_, "goshawk_bench");
  timer_ = std::make_unique<PlanTimer>(*node_, o.start_map, o.goal_map, o.map.limits());
  return success();
}

Status PlanRig::wait_until_ready(const std::string& folder) {
  const std::int64_t end_ns = node_->now_ns() + std::int64_t(kStagesReady_s * 1e9);
  while (!timer_->stages_ready() && node_->now_ns() < end_ns) {
    if (launch_->ended()) return launch_->failure();
    node_->spin_some(0.05);
  }
  if (timer_->stages_ready()) return success();
  return fail(
      ErrorCode::stage_silent,
      fmt::format("the stages did not report ready within {:g} s: see {}", kStagesReady_s, folder));
}

Result<PlanSample> PlanRig::sample() {
  for (int failures = 0;;) {
    auto sample = timer_->once(kPlan_s);
    if (!sample && ++failures > kMostFailures) return sample.error();
    node_->spin_some(sample ? 0.005 : 0.2);
    if (sample) return sample;
  }
}

double PlanRig::processor_s() const {
  std::map<std::string, std::vector<std::string>> processes;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    auto words = words_of(entry.path());
    if (words.size() > std::size_t(kUserTimeAt) + 1) processes.emplace(name, std::move(words));
  }
  const std::string top = std::to_string(launch_->pid());
  double ticks = 0.0;
  for (const auto& [name, words] : processes) {
    std::string at = name;
    for (auto known = processes.find(at); at != top && known != processes.end();
         known = processes.find(at)) {
      at = known->second[kParentAt];
    }
    if (at == top) ticks += std::stod(words[kUserTimeAt]) + std::stod(words[kUserTimeAt + 1]);
  }
  return ticks / double(sysconf(_SC_CLK_TCK));
}

}  // namespace goshawk::cli
