#include "flight/flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "flight/child_verb.hpp"
#include "flight/flight_folder.hpp"
#include "flight/recorded_world.hpp"
#include "flight/recorder_process.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/introspection/interruptible.hpp"

namespace goshawk::cli {
namespace {

namespace state = goshawk_msgs::msg::NavigatorState_Constants;

constexpr double kReady_s = 30.0;   // longest wait for the stages
constexpr double kSensor_s = 10.0;  // for the sensor, once all of them are ready
constexpr const char* kSensor = "lidar";
constexpr double kDiscovery_s = 0.5;  // among stages that we have found, it takes no longer

class Flight {
 public:
  /// @param recorded whether the recorder hears the planning stages
  Flight(const FlyOptions& options, const Preparation& preparation, const std::string& folder,
         const Say& say, runtime::Node& node, FlightEvents events, ChildVerb launch,
         std::function<bool()> recorded)
      : options_(options),
        p_(preparation),
        folder_(folder),
        say_(say),
        record_(node, std::move(events)),
        launch_(std::move(launch)),
        recorded_(std::move(recorded)) {}

  FlightOutcome fly() {
    FlightOutcome outcome;
    if (auto ready = wait_until_ready(); !ready) {
      if (ready.code() == ErrorCode::invalid_parameter) outcome.refusal = ready.error();
      LegOutcome leg;
      leg.goal_map = p_.tour.goals_map.front();
      leg.code = to_string(ready.code());
      leg.message = ready.error().message;
      outcome.legs.push_back(leg);
    } else {
      for (const Vec3& goal : p_.tour.goals_map) {
        outcome.legs.push_back(fly_leg(goal, outcome.legs.size() + 1));
        if (outcome.legs.back().arrived) continue;
        if (!options_.keep_going || !launch_lives()) break;
      }
    }
    outcome.end_ns = record_.now_ns();
    record_.tell("end", Json::object());
    launch_.stop();
    outcome.verdict = judge();
    return outcome;
  }

  const FlightRecorder& record() const { return record_; }

 private:
  Status launch_lives() {
    if (introspection::Interruptible::interrupted()) {
      return fail(ErrorCode::cancelled, "interrupted");
    }
    if (launch_.ended()) launch_failure_ = launch_.failure();
    if (launch_failure_) return *launch_failure_;
    return success();
  }

  Status wait_until_ready() {
    static constexpr StageRole kNeeded[] = {
        StageRole::map_server,       StageRole::path_search,
        StageRole::corridor_builder, StageRole::trajectory_optimizer,
        StageRole::navigator,        StageRole::tracker,
        StageRole::vehicle};
    Status lives = success();
    const auto missing = [&] {
      std::string names;
      for (const StageRole stage : kNeeded) {
        if (record_.is_ready(stage)) continue;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", to_string(stage));
      }
      return names;
    };
    say_("starting stages ...");
    record_.listen(kReady_s, [&] {
      lives = launch_lives();
      return !lives ||
             (missing().empty() && !record_.flown().empty() && record_.goal_readers() > 0);
    });
    if (!lives) return lives;
    if (const auto names = missing(); !names.empty()) {
      return fail(ErrorCode::stage_silent,
                  fmt::format("these stages did not report ready within {:g} s: {}; see {}/logs",
                              kReady_s, names, folder_));
    }
    if (record_.flown().empty() || record_.goal_readers() == 0) {
      return fail(ErrorCode::stage_silent, "no odometry came, or no stage reads goal_pose");
    }
    if (auto sensed = wait_for_sensor(); !sensed) return sensed;
    if (!record_.listen(5.0, recorded_)) say_("the recorder does not hear all stages yet");
    // The stages that we have found may not have found each other yet: the first plan needs the
    // map.
    record_.listen(kDiscovery_s, [] { return false; });
    say_("all stages ready");
    return success();
  }

  // Without it, --live would fly by a map that the launch file knows.
  Status wait_for_sensor() {
    if (!options_.live || record_.listen(kSensor_s, [&] { return record_.is_ready(kSensor); })) {
      return success();
    }
    return fail(
        ErrorCode::invalid_parameter,
        fmt::format("--live needs a launch file with a sensor named {}, such as live; {} has "
                    "none, or its sensor did not report ready within {:g} s",
                    kSensor, options_.launch.empty() ? "live" : options_.launch, kSensor_s));
  }

  LegOutcome fly_leg(const Vec3& goal, std::size_t number) {
    LegOutcome leg;
    leg.goal_map = goal;
    const std::int64_t begin_ns = record_.now_ns();
    std::int64_t said_ns = begin_ns;
    const std::size_t committed_before = record_.committed().size();
    Status lives = success();
    record_.tell("goal", {{"number", number}, {"goal", to_json(goal)}});
    record_.send_goal(goal);
    const bool answered = record_.listen(options_.timeout_s, [&] {
      lives = launch_lives();
      if (record_.now_ns() - said_ns > 1'000'000'000) {
        said_ns = record_.now_ns();
        say_progress(goal, number, double(said_ns - begin_ns) * 1e-9);
      }
      const auto& answer = record_.navigator();
      return !lives || (answer && (answer->state() == state::STATE_ARRIVED ||
                                   answer->state() == state::STATE_FAILED));
    });
    const auto answer = record_.navigator().value_or(goshawk_msgs::msg::NavigatorState());
    leg.arrived = lives.ok() && answered && answer.state() == state::STATE_ARRIVED;
    leg.request_id = answer.request_id();
    leg.flight_time_s = double(record_.now_ns() - begin_ns) * 1e-9;
    for (std::size_t i = committed_before; i < record_.committed().size(); ++i) {
      leg.commits.push_back(record_.committed()[i].id());
    }
    if (!lives) {
      leg.code = to_string(lives.code());
      leg.message = lives.error().message;
    } else if (!answered) {
      leg.code = to_string(ErrorCode::deadline_exceeded);
      leg.message = fmt::format("not arrived within {:g} s; the navigator is {}",
                                options_.timeout_s, state_word("silent"));
    } else {
      leg.code = answer.code();
      leg.message = answer.message();
    }
    record_.tell("leg", {{"number", number}, {"arrived", leg.arrived}, {"code", leg.code}});
    return leg;
  }

  /// @param none without an answer from the navigator
  std::string_view state_word(std::string_view none) const {
    const auto& answer = record_.navigator();
    return answer ? conversions::navigator_state_word(answer->state()) : none;
  }

  void say_progress(const Vec3& goal, std::size_t number, double elapsed_s) const {
    say_(fmt::format(
        "leg {} of {}: {:<8} {:5.1f} s, {:6.2f} m to go, tracking error {:5.1f} mm", number,
        p_.tour.goals_map.size(), state_word("asked"), elapsed_s,
        (record_.flown().back().state.position_map - goal).norm(),
        record_.errors().empty() ? 0.0 : 1e3 * record_.errors().back().position_error_m));
  }

  Result<flight_check::Verdict> judge() const {
    const auto track = flown_track(record_);
    if (track.empty()) return fail(ErrorCode::invalid_input, "nothing was flown");
    auto check = flight_check::FlightCheck::open(
        folder_ + "/world.bt", flight_check::Body{.radius_m = p_.config.map.radius_m});
    if (!check) return check.error();
    // The line across a gap may cut through what was flown around.
    if (auto gaps = flight_check::check_gaps(track); !gaps) return gaps.error();
    return check->judge(track);
  }

  const FlyOptions& options_;
  const Preparation& p_;
  const std::string& folder_;
  const Say& say_;
  FlightRecorder record_;
  ChildVerb launch_;
  std::optional<Error> launch_failure_;  // it has ended by itself
  std::function<bool()> recorded_;
};

Status check_domain_is_free(runtime::Context& context, runtime::Node& node, int domain) {
  node.spin_some(0.3);  // others announce themselves in this time
  for (const auto& participant : context.participants()) {
    for (const auto& name : participant.nodes) {
      if (!name.ends_with("/navigator")) continue;
      return fail(
          ErrorCode::io_failed,
          fmt::format("domain {} is in use: {} of the process {} is in it. Stop that flight, "
                      "or set ROS_DOMAIN_ID to another domain",
                      domain, name, participant.name));
    }
  }
  return success();
}

/// What a flight that never began leaves behind: nothing.
class FolderGuard {
 public:
  FolderGuard(const std::string& folder, bool existed) : folder_(folder), existed_(existed) {}
  ~FolderGuard() {
    std::error_code ignored;
    if (!kept_ && !existed_) std::filesystem::remove_all(folder_, ignored);
  }
  FolderGuard(const FolderGuard&) = delete;
  FolderGuard& operator=(const FolderGuard&) = delete;
  void keep() { kept_ = true; }

 private:
  std::string folder_;
  bool existed_;
  bool kept_ = false;
};

}  // namespace

Result<Json> fly(const FlyOptions& options, const Preparation& p, const Say& say) {
  const auto domain = private_domain();
  if (!domain) return domain.error();
  auto context_options = runtime::ContextOptions::from_environment();
  context_options->domain = *domain;
  auto context = runtime::Context::create(*context_options);
  if (!context) return context.error();
  runtime::Node node(**context, "goshawk_fly");
  if (auto free = check_domain_is_free(**context, node, *domain); !free) return free.error();
  const bool existed = !options.folder.empty() && std::filesystem::exists(options.folder);
  const auto folder = make_flight_folder(options, p);
  if (!folder) return folder.error();
  FolderGuard guard(*folder, existed);
  auto events = FlightEvents::open(*folder + "/events.jsonl");
  if (!events) return events.error();
  std::optional<ChildVerb> recorder;
  if (options.record) {
    auto started = start_recorder(*folder, *domain);
    if (!started) return started.error();
    recorder.emplace(*std::move(started));
  }
  auto launch =
      start_launch(launch_arguments(options, p, *folder), *domain, *folder + "/logs/launch.log");
  if (!launch) return launch.error();
  Flight flight(options, p, *folder, say, node, *std::move(events), *std::move(launch),
                [&] { return !recorder || hears_planning(**context, recorder->pid()); });
  const FlightOutcome outcome = flight.fly();
  if (recorder) recorder->stop();
  if (outcome.refusal) return *outcome.refusal;
  guard.keep();
  Json summary = summary_json(outcome, flight.record(), *folder);
  summary["why"] = nullptr;
  if (recorder && !outcome.all_arrived()) {
    summary["why"] = recorded_reason(*folder, outcome.end_ns);
  }
  if (auto written = write_flight(*folder, summary, flight.record(), p.tour.goals_map, p.map,
                                  p.config.map.radius_m, recorder.has_value(), say);
      !written) {
    return written.error();
  }
  return summary;
}

}  // namespace goshawk::cli
