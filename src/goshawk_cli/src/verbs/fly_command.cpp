#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>

#include "flight/flight_folder.hpp"
#include "flight/launch_process.hpp"
#include "flight/random_tour.hpp"
#include "flight/recorder_process.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/worlds/world.hpp"
#include "planning/plan_json.hpp"
#include "verbs.hpp"
#include "verbs/fly_options.hpp"

namespace goshawk::cli {

void FlyOptions::add_to(CLI::App& app) {
  map.add_to(app);
  app.add_option("--start", start, "x,y,z [m] where the vehicle hovers at first (default 3,0,1)");
  app.add_option("--goal", goals, "x,y,z [m]; may repeat, for a tour (default 3,8,2)");
  app.add_option("--random", random, "fly this many random reachable goals instead")
      ->check(not_negative());
  app.add_option("--seed", seed, "of the random goals")
      ->capture_default_str()
      ->check(not_negative());
  app.add_option("--min-distance", min_distance_m, "[m] between random goals")
      ->capture_default_str();
  app.add_option("--density", world_density, "of the made world (default 0.4)");
  app.add_option("--world-seed", world_seed, "of the made world")
      ->capture_default_str()
      ->check(not_negative());
  app.add_option("--launch", launch,
                 "launch file: flight (a process each), flight_container (one), "
                 "or one of your own")
      ->capture_default_str();
  app.add_option("--output", folder, "flight folder (default flights/DATE)");
  app.add_option("--timeout", timeout_s, "[s] for each goal")->capture_default_str();
  app.add_option("-p", stage_parameters, "parameter of a stage, node:name:=value; may repeat");
  app.add_flag("--no-record", no_record, "do not record the topics to flight.mcap");
  app.add_flag("--json", json, "print one JSON object (docs/cli.md)");
}

namespace {

constexpr double kAcquaintance_s = 0.5;  // discovery among those whom we found takes no longer

volatile sig_atomic_t interrupted = 0;

/// All that a flight needs before anything is started.
struct Preparation {
  std::string folder;
  std::string map_file;
  PlanningConfig config;
  LoadedMap map;
  Tour tour;
  Limits limits;
};

Result<std::string> make_folder(const FlyOptions& o) {
  std::string folder = o.folder;
  if (folder.empty()) {
    char name[40];
    const std::time_t now = std::time(nullptr);
    std::strftime(name, sizeof name, "flights/%Y-%m-%d_%H-%M-%S", std::localtime(&now));
    folder = name;
    for (int n = 2; std::filesystem::exists(folder); ++n) folder = name + ("_" + std::to_string(n));
  }
  std::error_code error;
  std::filesystem::create_directories(folder + "/logs", error);
  if (error) {
    return fail(ErrorCode::io_failed,
                "the flight folder " + folder + " cannot be made: " + error.message());
  }
  return std::filesystem::canonical(folder).string();
}

// The map to fly in: the user's, or a made world. The raw map is saved into the folder as well,
// for the second opinion and for whoever looks at the flight later.
Result<std::string> make_map(const FlyOptions& o, const std::string& folder) {
  if (!o.map.map.empty()) {
    std::error_code ignored;
    const auto path = std::filesystem::canonical(o.map.map, ignored);
    return path.empty() ? o.map.map : path.string();
  }
  auto spec = worlds::default_world();
  spec.seed = o.world_seed;
  if (o.world_density) spec.density = *o.world_density;
  const auto world = worlds::make_world(spec);
  if (!world) return world.error();
  const std::string file = folder + "/world.bt";
  const auto saved = map_server::save_voxels(world->geometry, world->occupied, {}, file);
  if (!saved) return saved.error();
  return file;
}

Result<Tour> make_tour(const FlyOptions& o, const PlanningConfig& config, const LoadedMap& map) {
  if (o.random > 0) {
    auto search = path_search::PathSearch::create(config.search);
    if (!search) return search.error();
    return random_tour(map.grown, *search, o.random, o.seed, o.min_distance_m);
  }
  const bool made = o.map.map.empty();
  if (!made && (o.start.empty() || o.goals.empty())) {
    return fail(ErrorCode::invalid_parameter,
                "a map of your own needs --start x,y,z and --goal x,y,z, or --random N");
  }
  Tour tour;
  auto start = parse_point(o.start.empty() ? "3,0,1" : o.start);
  if (!start) return fail(ErrorCode::invalid_parameter, "--start: " + start.error().message);
  tour.start_map = *start;
  for (const auto& text : o.goals.empty() ? std::vector<std::string>{"3,8,2"} : o.goals) {
    auto goal = parse_point(text);
    if (!goal) return fail(ErrorCode::invalid_parameter, "--goal: " + goal.error().message);
    tour.goals_map.push_back(*goal);
  }
  // A vehicle that stands in a wall cannot even hover: that is said before anything starts.
  auto located = locate(*map.grown, tour.start_map, Endpoint::start);
  if (!located) return located.error();
  return tour;
}

Result<Preparation> prepare(const FlyOptions& o) {
  auto limits = o.map.limits({});
  if (!limits) return limits.error();
  if (auto status = limits->check(); !status) return status.error();
  if (o.random < 0 || !(o.timeout_s > 0.0)) {
    return fail(ErrorCode::invalid_parameter, "--random must be 0 or more, --timeout above 0");
  }
  auto folder = make_folder(o);
  if (!folder) return folder.error();
  auto map_file = make_map(o, *folder);
  if (!map_file) return map_file.error();
  auto config = PlanningConfig::read(o.map.ros_args(*map_file));
  if (!config) return config.error();
  auto map = load_map(config->map);
  if (!map) return map.error();
  if (auto s = map_server::save_octree(*map->tree, *folder + "/world.bt"); !s) return s.error();
  auto tour = make_tour(o, *config, *map);
  if (!tour) return tour.error();
  return Preparation{*folder,         *map_file,        *std::move(config),
                     *std::move(map), *std::move(tour), *limits};
}

Arguments launch_arguments(const FlyOptions& o, const Preparation& p) {
  Arguments a{o.launch, "--log-dir", p.folder + "/logs", "--ros-args"};
  const auto set = [&](const std::string& name, const std::string& value) {
    a.insert(a.end(), {"-p", name + ":=" + value});
  };
  for (const auto& file : o.map.params_files) {
    a.insert(a.end(), {"--params-file", std::filesystem::absolute(file).string()});
  }
  for (const auto& override : o.map.ros_args(p.map_file).overrides) {
    set(override.node + ":" + override.name, override.value);
  }
  for (int axis = 0; axis < 3; ++axis) {
    char value[40];
    std::snprintf(value, sizeof value, "%.17g", p.tour.start_map[axis]);
    set(std::string("simulator:start_") + "xyz"[axis] + "_m", value);
  }
  for (const auto& [name, value] : {std::pair{"v_max_m_s", &o.map.v_max},
                                    {"a_max_m_s2", &o.map.a_max},
                                    {"limit_norm", &o.map.norm},
                                    {"j_max_m_s3", &o.map.j_max},
                                    {"v_max_vertical_m_s", &o.map.v_max_vertical},
                                    {"a_max_vertical_m_s2", &o.map.a_max_vertical}}) {
    if (!value->empty()) set(std::string("navigator:") + name, *value);
  }
  for (const auto& parameter : o.stage_parameters) a.insert(a.end(), {"-p", parameter});
  return a;
}

class Flight {
 public:
  /// @param recorded whether the recorder hears the planning stages
  Flight(const FlyOptions& options, const Preparation& preparation, runtime::Node& node,
         LaunchProcess launch, std::function<bool()> recorded)
      : options_(options),
        p_(preparation),
        record_(node),
        launch_(std::move(launch)),
        recorded_(std::move(recorded)) {}

  FlightOutcome fly() {
    FlightOutcome outcome;
    if (auto ready = wait_until_ready(); !ready) {
      LegOutcome leg;
      leg.goal_map = p_.tour.goals_map.front();
      leg.code = to_string(ready.code());
      leg.message = ready.error().message;
      outcome.legs.push_back(leg);
    } else {
      for (const Vec3& goal : p_.tour.goals_map) {
        outcome.legs.push_back(fly_leg(goal, outcome.legs.size() + 1));
        if (!outcome.legs.back().arrived) break;
      }
    }
    launch_.stop();
    outcome.verdict = judge();
    return outcome;
  }

  const FlightRecorder& record() const { return record_; }

 private:
  void progress(const std::string& line) const { std::fprintf(stderr, "%s\n", line.c_str()); }

  Status launch_lives() {
    if (interrupted != 0) return fail(ErrorCode::io_failed, "interrupted");
    if (auto status = launch_.ended()) {
      return fail(ErrorCode::stage_silent,
                  "a stage could not be started (launch ended with status " +
                      std::to_string(*status) + "): see " + p_.folder + "/logs/launch.log");
    }
    return success();
  }

  Status wait_until_ready() {
    static constexpr const char* kNeeded[] = {
        "map_server", "path_search", "corridor_builder", "trajectory_optimizer",
        "navigator",  "tracker",     "simulator"};
    Status lives = success();
    const auto missing = [&] {
      std::string names;
      for (const char* stage : kNeeded) {
        if (!record_.is_ready(stage)) names += (names.empty() ? "" : ", ") + std::string(stage);
      }
      return names;
    };
    progress("starting stages ...");
    record_.listen(30.0, [&] {
      lives = launch_lives();
      return !lives ||
             (missing().empty() && !record_.flown().empty() && record_.goal_readers() > 0);
    });
    if (!lives) return lives;
    if (const auto names = missing(); !names.empty()) {
      return fail(ErrorCode::stage_silent, "these stages did not report ready within 30 s: " +
                                               names + "; see " + p_.folder + "/logs");
    }
    if (record_.flown().empty() || record_.goal_readers() == 0) {
      return fail(ErrorCode::stage_silent, "no odometry came, or nobody listens on goal_pose");
    }
    if (!record_.listen(5.0, recorded_)) progress("the recorder does not hear all stages yet");
    // Whom we found may not have found each other: the first plan wants its map and the recorder.
    record_.listen(kAcquaintance_s, [] { return false; });
    progress("all stages ready");
    return success();
  }

  LegOutcome fly_leg(const Vec3& goal, std::size_t number) {
    LegOutcome leg;
    leg.goal_map = goal;
    const std::int64_t begin_ns = record_.now_ns();
    std::int64_t said_ns = begin_ns;
    Status lives = success();
    record_.send_goal(goal);
    const bool answered = record_.listen(options_.timeout_s, [&] {
      lives = launch_lives();
      if (record_.now_ns() - said_ns > 1'000'000'000) {
        said_ns = record_.now_ns();
        say_progress(goal, number, double(said_ns - begin_ns) * 1e-9);
      }
      const auto& state = record_.navigator().state();
      return !lives || state == "arrived" || state == "failed";
    });
    const auto& state = record_.navigator();
    leg.arrived = lives.ok() && answered && state.state() == "arrived";
    leg.request_id = state.request_id();
    leg.flight_time_s = double(record_.now_ns() - begin_ns) * 1e-9;
    if (!lives) {
      leg.code = to_string(lives.code());
      leg.message = lives.error().message;
    } else if (!answered) {
      leg.code = to_string(ErrorCode::deadline_exceeded);
      leg.message = "not arrived within " + std::to_string(options_.timeout_s) +
                    " s; navigator is " + (state.state().empty() ? "silent" : state.state());
    } else {
      leg.code = state.code();
      leg.message = state.message();
    }
    return leg;
  }

  void say_progress(const Vec3& goal, std::size_t number, double elapsed_s) const {
    const auto& state = record_.navigator().state();
    char line[160];
    std::snprintf(line, sizeof line,
                  "leg %zu of %zu: %-8s %5.1f s, %6.2f m to go, tracking error %5.1f mm", number,
                  p_.tour.goals_map.size(), state.empty() ? "asked" : state.c_str(), elapsed_s,
                  (record_.flown().back().state.position_map - goal).norm(),
                  record_.errors().empty() ? 0.0 : 1e3 * record_.errors().back().position_error_m);
    progress(line);
  }

  Result<flight_check::Verdict> judge() const {
    const auto track = flown_track(record_);
    if (track.empty()) return fail(ErrorCode::invalid_input, "nothing was flown");
    auto check = flight_check::FlightCheck::open(
        p_.folder + "/world.bt", flight_check::Body{.radius_m = p_.config.map.radius_m});
    if (!check) return check.error();
    // The line across a gap may cut through what was flown around.
    if (auto gaps = flight_check::check_gaps(track); !gaps) return gaps.error();
    return check->judge(track);
  }

  const FlyOptions& options_;
  const Preparation& p_;
  FlightRecorder record_;
  LaunchProcess launch_;
  std::function<bool()> recorded_;
};

Status check_domain_is_free(runtime::Context& context, runtime::Node& node, int domain) {
  node.spin_some(0.3);  // others announce themselves in this time
  for (const auto& participant : context.participants()) {
    for (const auto& name : participant.nodes) {
      if (!name.ends_with("/navigator")) continue;
      return fail(ErrorCode::io_failed, "domain " + std::to_string(domain) +
                                            " is in use: another flight's " + name +
                                            " is in it. Stop it, or set ROS_DOMAIN_ID to another");
    }
  }
  return success();
}

Result<Json> fly(const FlyOptions& options, const Preparation& p) {
  const auto domain = private_domain();
  if (!domain) return domain.error();
  auto context_options = runtime::ContextOptions::from_environment();
  context_options->domain = *domain;
  auto context = runtime::Context::create(*context_options);
  if (!context) return context.error();
  runtime::Node node(**context, "goshawk_fly");
  if (auto free = check_domain_is_free(**context, node, *domain); !free) return free.error();
  std::optional<LaunchProcess> recorder;
  if (!options.no_record) {
    auto started = start_recorder(p.folder, *domain);
    if (!started) return started.error();
    recorder.emplace(*std::move(started));
  }
  auto launch =
      LaunchProcess::start(launch_arguments(options, p), *domain, p.folder + "/logs/launch.log");
  if (!launch) return launch.error();
  Flight flight(options, p, node, *std::move(launch),
                [&] { return !recorder || hears_planning(**context, recorder->pid()); });
  const FlightOutcome outcome = flight.fly();
  if (recorder) recorder->stop();
  const Json summary = summary_json(outcome, flight.record(), p.folder);
  if (auto written = write_flight(p.folder, summary, flight.record(), p.map, p.config.map.radius_m);
      !written) {
    return written.error();
  }
  return summary;
}

bool is_wrong_call(ErrorCode code) {
  return code == ErrorCode::invalid_parameter;
}

}  // namespace

int fly_command(const Arguments& arguments) {
  CLI::App app("Fly: start every stage as a process of its own, send the goals, judge the flight.",
               "goshawk fly");
  app.footer(
      "Examples:\n"
      "  goshawk fly\n"
      "  goshawk fly --map office.bt --start 1,1,1 --goal 8,4,1.5 --goal 1,1,1\n"
      "  goshawk fly --random 5 --seed 7 --launch flight_container -p simulator:wind_x_m_s:=2\n"
      "  goshawk view shows the newest flight, goshawk check judges it again.");
  FlyOptions options;
  options.add_to(app);
  if (const auto status = parse(app, arguments)) return *status;
  signal(SIGINT, [](int) { interrupted = 1; });
  signal(SIGTERM, [](int) { interrupted = 1; });
  const auto preparation = prepare(options);
  if (!preparation) {
    return report_failure(preparation.error(), options.json,
                          is_wrong_call(preparation.code()) ? kWrongCall : kNotDone);
  }
  const auto summary = fly(options, *preparation);
  if (!summary) return report_failure(summary.error(), options.json, kNotDone);
  options.json ? void(std::printf("%s\n", summary->dump(2).c_str())) : print_summary(*summary);
  return (*summary)["ok"].get<bool>() ? kDone : kNotDone;
}

}  // namespace goshawk::cli
