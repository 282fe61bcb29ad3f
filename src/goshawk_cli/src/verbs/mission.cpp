#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <optional>

#include "flight/mission_watch.hpp"
#include "flight/operator_client.hpp"
#include "flight/pilot.hpp"
#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/mission/mission_file.hpp"
#include "json.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

namespace state_of = goshawk_msgs::msg::MissionState_Constants;
using Steady = std::chrono::steady_clock;

constexpr double kMapWait_s = 2.0;

struct MissionOptions {
  std::string file;
  bool check = false, cancel = false, detach = false, unchecked = false;
  VehicleOptions vehicle{.timeout_s = 86400.0};
};

Json summary_of(const mission::MissionFile& file) {
  Json object = ok_json();
  object["name"] = file.mission.name;
  object["waypoints"] = file.mission.waypoints.size();
  object["length_m"] =
      mission::length_from(file.mission, 0, file.mission.waypoints.front().position_map);
  return object;
}

int print_summary(const mission::MissionFile& file, const Console& console) {
  const Json object = summary_of(file);
  if (console.json()) {
    console.print(object);
  } else {
    fmt::print("{}: {} waypoints, {:.1f} m from the first to the last\n", file.mission.name,
               file.mission.waypoints.size(), object["length_m"].get<double>());
  }
  return kDone;
}

/// What the flight's map shows at the waypoints. Unknown space may be seen on the way.
Status check_map(introspection::Session& session, const std::string& space, const std::string& path,
                 const mission::MissionFile& file) {
  using Grid = goshawk_msgs::msg::VoxelGrid;
  // Maps come as long as the session lasts, after this function has returned.
  const auto first = std::make_shared<std::optional<Grid>>();
  session.node().subscribe<Grid>(topic_in(space, "map/voxels"), runtime::Qos::latched(),
                                 [first](const Grid& m, const auto&) {
                                   if (!*first) *first = m;
                                 });
  session.wait_for(kMapWait_s, [&] { return first->has_value(); });
  if (!*first) return success();  // the navigator will say what is wrong with it
  const auto grid = conversions::from_msg(**first);
  if (!grid) return success();
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    const auto place = locate(*grid, file.mission.waypoints[i].position_map, Endpoint::goal);
    if (place || place.code() == ErrorCode::goal_unknown) continue;
    return fail(place.code(), fmt::format("{}, line {}: waypoint {}: {} (--unchecked sends it all "
                                          "the same)",
                                          path, file.lines[i], i + 1, place.error().message));
  }
  return success();
}

/// Progress on one line: it is written over on a terminal, else only what is new is said.
class ProgressLine {
 public:
  explicit ProgressLine(const Console& console)
      : console_(console), terminal_(::isatty(STDERR_FILENO) != 0) {}
  ~ProgressLine() {
    if (open_) fmt::print(stderr, "\n");
  }
  void tell(const std::string& line, bool is_new) {
    if (terminal_) {
      fmt::print(stderr, "\r\x1b[K{}", line);
      std::fflush(stderr);
      open_ = true;
    } else if (is_new) {
      console_.say(line);
    }
  }

 private:
  const Console& console_;
  bool terminal_;
  bool open_ = false;
};

/// @param time_s since it was sent; none: somebody else has sent it
int tell_end(const MissionWatch::State& state, std::optional<double> time_s,
             const Console& console) {
  if (state.state() != state_of::STATE_DONE) {
    return console.not_done({conversions::error_code_of(state.code()), state.message()});
  }
  if (console.json()) {
    Json object = ok_json();
    object.update({{"name", state.name()},
                   {"waypoints", state.waypoints()},
                   {"time_s", time_s ? to_json(*time_s) : Json(nullptr)}});
    console.print(object);
  } else {
    fmt::print("{}: all {} waypoints reached{}\n", state.name(), state.waypoints(),
               time_s ? fmt::format(" after {:.1f} s", *time_s) : "");
  }
  return kDone;
}

/// @param sent when the mission was sent, if this process did
int follow(MissionWatch& watch, std::uint64_t id, std::optional<Steady::time_point> sent,
           const MissionOptions& o, const Console& console) {
  const auto end = [&] {
    ProgressLine line(console);
    return watch.follow(id, o.vehicle.timeout_s,
                        [&line](const std::string& text, bool is_new) { line.tell(text, is_new); });
  }();
  if (!end) return console.not_done(end.error());
  std::optional<double> time_s;
  if (sent) time_s = std::chrono::duration<double>(Steady::now() - *sent).count();
  return tell_end(*end, time_s, console);
}

int watch_or_cancel(introspection::Session& session, const std::string& space,
                    const MissionOptions& o, const Console& console) {
  if (o.cancel) {
    namespace verb_of = goshawk_msgs::msg::OperatorCommand_Constants;
    OperatorClient client(session, space);
    const auto answer = client.command(verb_of::VERB_CANCEL_MISSION, 0.0, o.vehicle.ready_s);
    if (!answer) return console.failed(answer.error());
    if (!console.json()) fmt::print("{}\n", *answer);
    if (console.json()) console.print(ok_json());
    return kDone;
  }
  MissionWatch watch(session, space);
  const auto state = watch.newest(o.vehicle.ready_s);
  if (!state) return console.failed(state.error());
  if (state->state() == state_of::STATE_NONE) {
    return console.not_done({ErrorCode::invalid_input, "no mission was sent yet: name its file"});
  }
  return follow(watch, state->id(), {}, o, console);
}

int send(introspection::Session& session, const std::string& space,
         const mission::MissionFile& file, const MissionOptions& o, const Console& console) {
  if (!o.unchecked) {
    if (auto status = check_map(session, space, o.file, file); !status) {
      return console.not_done(status.error());
    }
  }
  MissionWatch watch(session, space);
  OperatorClient client(session, space);
  const auto id = client.fly(file.mission, o.vehicle.ready_s);
  if (!id) return console.failed(id.error());
  return o.detach ? print_summary(file, console) : follow(watch, *id, Steady::now(), o, console);
}

int run_mission(const MissionOptions& o, const Console& console) {
  if (o.file.empty() && (o.check || o.detach)) {
    return console.wrong_call({ErrorCode::invalid_input, "name the mission's file"});
  }
  std::optional<mission::MissionFile> file;
  if (!o.file.empty()) {
    auto read = mission::read_mission(o.file);
    if (!read) return console.not_done(read.error());
    file = *std::move(read);
    if (o.check) return print_summary(*file, console);
  }
  const auto space = introspection::full_topic_name(o.vehicle.space);
  if (!space) return console.failed(space.error());
  auto session = introspection::Session::open();
  if (!session) return console.failed(session.error());
  return file ? send(**session, *space, *file, o, console)
              : watch_or_cancel(**session, *space, o, console);
}

}  // namespace

void add_mission(Program& program) {
  const Verb verb = program.verb("mission",
                                 "fly the waypoints of a file, or watch the mission that "
                                 "is flown");
  auto o = std::make_shared<MissionOptions>();
  verb->add_option("file", o->file, ".yaml, .yml or .csv (docs/missions.md); none: watch");
  verb->add_flag("--check", o->check, "only read the file, and say what is wrong with it");
  verb->add_flag("--detach", o->detach, "do not wait for its end");
  verb->add_flag("--cancel", o->cancel, "end the mission that is flown")->excludes("file");
  verb->add_flag("--unchecked", o->unchecked,
                 "do not ask the flight's map first whether the waypoints are free");
  add_vehicle_options(verb, o->vehicle);
  verb->footer(
      "The stage mission flies it (goshawk launch flight_mission), so that the mission goes on\n"
      "if this terminal closes. goshawk hold pauses it, goshawk resume goes on.\n\n"
      "Examples:\n"
      "  goshawk mission survey.yaml\n"
      "  goshawk mission survey.csv --check\n"
      "  goshawk mission                     watch the one that is flown\n"
      "  goshawk mission --cancel");
  verb.runs([o](const Console& console) { return run_mission(*o, console); });
}

}  // namespace goshawk::cli
