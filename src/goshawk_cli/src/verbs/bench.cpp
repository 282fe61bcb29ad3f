#include "verbs/bench.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "process.hpp"

namespace goshawk::cli {
namespace {

/// Options that most programs of goshawk_benchmarks take.
struct CommonOptions {
  bool quick = false;
  std::string plots;
};

/// Becomes lib/goshawk/bench_NAME, which takes its options as JSON.
int become_bench(const std::string& name, const Json& options, const Console& console) {
  const std::string program = "bench_" + name;
  if (!std::filesystem::exists(install_prefix() + "/lib/goshawk/" + program)) {
    return console.not_done({ErrorCode::io_failed,
                             program + " is not built: build with the tests, as tools/build does"});
  }
  return become_helper(program, options, console);
}

std::shared_ptr<CommonOptions> add_common(const Verb& verb) {
  auto o = std::make_shared<CommonOptions>();
  verb->add_flag("--quick", o->quick, "less of everything: ends within 40 s");
  verb->add_option("--plots", o->plots, "folder for pictures and the report as JSON");
  return o;
}

Json common_json(const CommonOptions& o) {
  return {{"quick", o.quick}, {"plots", o.plots}};
}

void add_plain(const Verb& bench, const std::string& name, const std::string& summary) {
  const Verb verb = bench.word(name, summary);
  const auto common = add_common(verb);
  verb->footer(fmt::format("Example:\n  goshawk bench {} --quick", name));
  verb.runs([=](const Console& c) { return become_bench(name, common_json(*common), c); });
}

void add_dds(const Verb& bench) {
  const Verb verb =
      bench.word("dds", "the middleware alone, by transport and size; setpoints beside large maps");
  const auto common = add_common(verb);
  auto part = std::make_shared<std::string>("all");
  verb.choice("--part", *part, "what to measure: all, ways, hand_over, maps",
              {"all", "ways", "hand_over", "maps"})
      ->capture_default_str();
  verb->footer("Example:\n  goshawk bench dds --quick --part hand_over");
  verb.runs([=](const Console& c) {
    Json options = common_json(*common);
    options["part"] = *part;
    return become_bench("dds", options, c);
  });
}

void add_map(const Verb& bench) {
  const Verb verb = bench.word("map", "scans into the live map, growth included, beside OctoMap");
  const auto common = add_common(verb);
  auto cloud = std::make_shared<std::string>();
  verb->add_option("--cloud", *cloud,
                   "a scan as .pcd or .ply in its sensor's frame; default: a made hall");
  auto processes = std::make_shared<bool>(false);
  verb->add_flag("--processes", *processes,
                 "instead: from a cloud's message to a planner's map, over separate processes");
  verb->footer("Example:\n  goshawk bench map --quick");
  verb.runs([=](const Console& c) {
    Json options = common_json(*common);
    options["cloud"] = *cloud;
    options["processes"] = *processes;
    return become_bench("map", options, c);
  });
}

void add_scenario(const Verb& bench) {
  struct Options {
    std::string map, scenario;
    int limit = 0;  // 0: all
    std::vector<std::string> planners;
  };
  const Verb verb = bench.word("scenario", "lengths and times on public voxel problems");
  auto o = std::make_shared<Options>();
  verb->add_option("map", o->map, "MAP.3dmap")->required();
  verb->add_option("scenario", o->scenario, "SCENARIO.3dscen")->required();
  verb->add_option("--limit", o->limit, "only the first N problems")->check(CLI::PositiveNumber);
  verb->add_option("--planner", o->planners, "one or several (default: all that search)");
  verb->footer("Example:\n  goshawk bench scenario A1.3dmap A1.3dscen --limit 100");
  verb.runs([o](const Console& c) {
    return become_bench("scenario",
                        {{"map", o->map},
                         {"scenario", o->scenario},
                         {"limit", o->limit},
                         {"planners", o->planners}},
                        c);
  });
}

void add_stage(const Verb& bench) {
  struct Options {
    std::string stage, input, against;
    int count = 200;
    double rate_hz = 0.0;
  };
  const Verb verb = bench.word(
      "stage", "one stage fed from a recording, in a process and in one, beside another's");
  auto o = std::make_shared<Options>();
  verb.choice("stage", o->stage, "one of the stages below",
              {"path_search", "corridor_builder", "trajectory_optimizer", "tracker", "map_server"})
      ->required();
  verb->add_option("--input", o->input, "an MCAP recording with the stage's inputs")->required();
  verb->add_option("--against", o->against, "command of another implementation, beside ours");
  verb->add_option("-n,--count", o->count, "requests")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  verb->add_option("--rate", o->rate_hz,
                   "[Hz] whether answered or not; 0: the next when the last is answered")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e5));
  const auto common = add_common(verb);
  verb->footer(
      "Stages: path_search, corridor_builder, trajectory_optimizer, tracker, map_server.\n\n"
      "Example:\n  goshawk bench stage path_search --input flight.mcap --against ./my_search");
  verb.runs([=](const Console& c) {
    Json options = common_json(*common);
    options.update({{"stage", o->stage},
                    {"input", o->input},
                    {"against", o->against},
                    {"count", o->count},
                    {"rate_hz", o->rate_hz}});
    return become_bench("stage", options, c);
  });
}

}  // namespace

void add_bench(Program& program) {
  const Verb bench =
      program.verb("bench", "measure plans over DDS, or a stage beside its baselines");
  add_bench_plan(bench);
  add_stage(bench);
  add_dds(bench);
  add_plain(bench, "search", "grid searches beside a plain A*: time, nodes, length, growth");
  add_scenario(bench);
  add_plain(bench, "corridor", "corridor generators: time, volume, faces, obstacles cut");
  add_map(bench);
  add_plain(bench, "updates", "what an update of a large map costs each stage that follows it");
  add_plain(bench, "guard", "what it costs to make another planner's plan safe");
  add_plain(bench, "replan", "what it takes to plan again in a forest that unfolds");
  add_plain(bench, "trajectory", "planners: durations, speeds, optimisation and whole plans");
  add_plain(bench, "sensors", "simulated lidars and cameras: what a ray costs in each world");
  add_plain(bench, "obstacles", "a tracker of what moves, judged against the truth");
  add_plain(bench, "senses", "what the live map keeps of thin things, rain, and grazed floors");
  add_plain(bench, "tracking",
            "closed-loop flights: errors by controller, weather and plant, step times");
}

}  // namespace goshawk::cli
