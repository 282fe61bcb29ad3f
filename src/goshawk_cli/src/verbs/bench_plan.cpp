#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>

#include "flight/launch_process.hpp"
#include "folders.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/runtime/node.hpp"
#include "planning/map_options.hpp"
#include "verbs.hpp"

namespace goshawk::cli {
namespace {

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;

struct BenchOptions {
  MapOptions map;
  std::string start = "3,0,1";
  std::string goal = "3,8,2";
  std::string launch = "flight";
  int count = 200;
  bool json = false;
};

/// One plan, in nanoseconds.
struct Sample {
  std::int64_t total_ns = 0;
  std::map<std::string, std::pair<std::int64_t, std::int64_t>> stages;  // name: compute, wire
};

constexpr const char* kPlanningStages[] = {"path_search", "corridor_builder",
                                           "trajectory_optimizer"};
constexpr std::uint64_t kFirstId = 1;

/// Asks for plans as the navigator would, one after another, and times the answers.
class PlanTimer {
 public:
  PlanTimer(Node& node, const Vec3& start, const Vec3& goal, const Limits& limits)
      : node_(node),
        requests_(node.advertise<msg::PlanRequest>("plan_request", Qos::reliable_last())) {
    request_.start.position = start;
    request_.goal.position = goal;
    request_.limits = limits;
    request_.id = kFirstId;
    node.subscribe<msg::BezierTrajectory>(
        "trajectory", Qos::reliable_last(),
        [this](const msg::BezierTrajectory& m, const MessageInfo& info) {
          if (m.request().id() != request_.id) return;
          const auto received = conversions::from_msg(m);
          if (!received) return;
          sample_.total_ns = info.received_ns - request_.stamp_ns;
          final_wire_ns_ = info.received_ns - conversions::to_ns(m.header().stamp());
        });
    node.subscribe<msg::StageReport>(
        "stage_report", Qos::latched(100),
        [this](const msg::StageReport& m, const MessageInfo&) { on_report(m); });
  }

  bool stages_ready() const {
    return std::ranges::all_of(kPlanningStages, [&](const char* s) { return ready_.contains(s); });
  }

  /// @return the sample, or why there is none
  Result<Sample> once(double timeout_s) {
    sample_ = {};
    failure_.reset();
    ++request_.id;
    request_.stamp_ns = node_.now_ns();
    if (auto s = requests_.publish(conversions::to_msg(request_)); !s) return s.error();
    const std::int64_t end_ns = request_.stamp_ns + std::int64_t(timeout_s * 1e9);
    while (node_.now_ns() < end_ns && !failure_ &&
           (sample_.total_ns == 0 || sample_.stages.size() < std::size(kPlanningStages))) {
      node_.spin_some(0.05);
    }
    if (failure_) return *failure_;
    if (sample_.total_ns == 0) {
      return fail(ErrorCode::stage_silent,
                  "no trajectory came within " + std::to_string(timeout_s) + " s");
    }
    sample_.stages["reply"] = {0, final_wire_ns_};
    return sample_;
  }

 private:
  void on_report(const msg::StageReport& m) {
    if (m.request_id() == 0 && m.code() == "ok") ready_[m.stage()] = m.implementation();
    if (m.request_id() != request_.id) return;
    if (m.code() == "ok") {
      sample_.stages[m.stage()] = {m.compute_ns(), m.wire_ns()};
    } else {
      failure_ = fail(ErrorCode::invalid_input, m.stage() + ": " + m.code() + ": " + m.message());
    }
  }

  Node& node_;
  Publisher<msg::PlanRequest> requests_;
  PlanRequest request_;
  std::map<std::string, std::string> ready_;
  Sample sample_;
  std::int64_t final_wire_ns_ = 0;
  std::optional<Error> failure_;
};

double percentile_us(std::vector<std::int64_t> values, double share) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  const auto at = std::size_t(share * double(values.size() - 1) + 0.5);
  return double(values[at]) * 1e-3;
}

Json percentiles(const std::vector<std::int64_t>& values) {
  return {{"p50_us", percentile_us(values, 0.5)},
          {"p90_us", percentile_us(values, 0.9)},
          {"p99_us", percentile_us(values, 0.99)},
          {"max_us", percentile_us(values, 1.0)}};
}

Json result_json(const std::vector<Sample>& samples, const BenchOptions& o) {
  std::vector<std::int64_t> totals;
  std::vector<std::int64_t> wires;
  for (const auto& s : samples) {
    totals.push_back(s.total_ns);
    std::int64_t compute_ns = 0;
    for (const auto& [name, times] : s.stages) compute_ns += times.first;
    wires.push_back(s.total_ns - compute_ns);
  }
  Json stages = Json::array();
  for (const char* name : {"path_search", "corridor_builder", "trajectory_optimizer", "reply"}) {
    std::vector<std::int64_t> compute;
    std::vector<std::int64_t> wire;
    for (const auto& s : samples) {
      const auto found = s.stages.find(name);
      if (found == s.stages.end()) continue;
      compute.push_back(found->second.first);
      wire.push_back(found->second.second);
    }
    stages.push_back(
        {{"name", name}, {"compute", percentiles(compute)}, {"wire", percentiles(wire)}});
  }
  return {{"ok", true},
          {"code", "ok"},
          {"message", ""},
          {"launch", o.launch},
          {"plans", samples.size()},
          {"total", percentiles(totals)},
          {"not_compute", percentiles(wires)},
          {"stages", stages}};
}

void print(const Json& result) {
  std::printf("%zu plans, launch file %s\n", result["plans"].get<std::size_t>(),
              result["launch"].get<std::string>().c_str());
  std::printf("%-22s %12s %12s %12s %12s\n", "[us]", "compute p50", "compute p99", "wire p50",
              "wire p99");
  for (const auto& s : result["stages"]) {
    std::printf("%-22s %12.1f %12.1f %12.1f %12.1f\n", s["name"].get<std::string>().c_str(),
                s["compute"]["p50_us"].get<double>(), s["compute"]["p99_us"].get<double>(),
                s["wire"]["p50_us"].get<double>(), s["wire"]["p99_us"].get<double>());
  }
  std::printf("%-22s p50 %.1f us, p99 %.1f us, of which not computing p50 %.1f us\n", "whole plan",
              result["total"]["p50_us"].get<double>(), result["total"]["p99_us"].get<double>(),
              result["not_compute"]["p50_us"].get<double>());
}

Result<std::vector<Sample>> measure(const BenchOptions& o, const std::string& map_file,
                                    const std::string& folder, const Vec3& start, const Vec3& goal,
                                    const Limits& limits) {
  const auto domain = private_domain();
  if (!domain) return domain.error();
  auto options = ContextOptions::from_environment();
  options->domain = *domain;
  auto context = Context::create(*options);
  if (!context) return context.error();
  Node node(**context, "goshawk_bench");
  PlanTimer timer(node, start, goal, limits);
  Arguments arguments{o.launch, "--log-dir", folder, "--ros-args"};
  for (const auto& p : o.map.ros_args(map_file).overrides) {
    arguments.insert(arguments.end(), {"-p", p.node + ":" + p.name + ":=" + p.value});
  }
  auto launch = LaunchProcess::start(arguments, *domain, folder + "/launch.log");
  if (!launch) return launch.error();
  const std::int64_t end_ns = node.now_ns() + 30'000'000'000;
  while (!timer.stages_ready() && node.now_ns() < end_ns && !launch->ended()) node.spin_some(0.05);
  if (!timer.stages_ready()) {
    return fail(ErrorCode::stage_silent, "the stages did not report ready within 30 s");
  }
  std::vector<Sample> samples;
  for (int failures = 0; int(samples.size()) < o.count + 10;) {  // the first ten warm up
    auto sample = timer.once(2.0);
    if (sample) {
      samples.push_back(*std::move(sample));
      node.spin_some(0.005);
    } else if (++failures > 10) {  // the map may not be there for the first ones
      return sample.error();
    } else {
      node.spin_some(0.2);
    }
  }
  samples.erase(samples.begin(), samples.begin() + 10);
  return samples;
}

int run(const BenchOptions& o) {
  const auto start = parse_point(o.start);
  const auto goal = parse_point(o.goal);
  if (!start || !goal)
    return report_failure(start ? goal.error() : start.error(), o.json, kWrongCall);
  const auto limits = o.map.limits({});
  if (!limits) return report_failure(limits.error(), o.json, kWrongCall);
  const TemporaryFolder folder;
  const auto world = o.map.map.empty() ? save_default_world(folder.path())
                                       : Result<std::string>(std::filesystem::absolute(o.map.map));
  if (!world) return report_failure(world.error(), o.json, kNotDone);
  const auto samples = measure(o, *world, folder.path(), *start, *goal, *limits);
  if (!samples) return report_failure(samples.error(), o.json, kNotDone);
  const Json result = result_json(*samples, o);
  o.json ? print_json(result) : print(result);
  return kDone;
}

}  // namespace

int bench_plan_command(const Arguments& arguments) {
  CLI::App app("Latency of whole plans over DDS, by stage: compute, and time on the wire.",
               "goshawk bench plan");
  app.footer(
      "Examples:\n"
      "  goshawk bench plan\n"
      "  goshawk bench plan --launch flight_container -n 1000 --json");
  BenchOptions o;
  o.map.add_to(app);
  app.add_option("--start", o.start, "x,y,z [m]")->capture_default_str();
  app.add_option("--goal", o.goal, "x,y,z [m]")->capture_default_str();
  app.add_option("--launch", o.launch, "flight (a process each) or flight_container (one)")
      ->capture_default_str();
  app.add_option("-n,--count", o.count, "plans")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  app.add_flag("--json", o.json, "print one JSON object (docs/cli.md)");
  if (const auto status = parse(app, arguments)) return *status;
  return run(o);
}

}  // namespace goshawk::cli
