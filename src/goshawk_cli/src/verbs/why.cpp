#include "goshawk/why/why.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <set>

#include "flight/why_json.hpp"
#include "goshawk/introspection/session.hpp"
#include "goshawk/why_messages/snapshot_collector.hpp"
#include "json.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

struct WhyOptions {
  std::string recording;
  std::optional<double> at_s;
  VehicleOptions vehicle;
};

int tell(const why::Snapshot& snapshot, const Console& console) {
  const why::Reason reason = why::explain(snapshot);
  if (console.json()) {
    Json object = ok_json();
    object.update(to_json(reason));
    object["map_version"] = snapshot.map ? Json(snapshot.map->version) : Json(nullptr);
    object["map_age_s"] = snapshot.map ? to_json(snapshot.map_age_s) : Json(nullptr);
    console.print(object);
    return kDone;
  }
  for (const std::string& sentence : {reason.doing, reason.because, reason.mend}) {
    if (!sentence.empty()) fmt::print("{}\n", sentence);
  }
  return kDone;
}

/// A flight folder, or a recording.
std::string recording_in(const std::string& path) {
  const auto file = std::filesystem::path(path) / "flight.mcap";
  return std::filesystem::exists(file) ? file.string() : path;
}

/// The vehicle's namespace: the one that was asked for, or the only one that was recorded.
Result<std::string> space_in(const recording::Reader& reader, const std::string& wanted) {
  auto space = introspection::full_topic_name(wanted);
  if (!space || *space != "/") return space;
  constexpr std::string_view kOfEachVehicle = "/navigator_state";
  std::set<std::string> spaces;
  for (const auto& [id, channel] : reader.channels()) {
    if (!channel.topic.ends_with(kOfEachVehicle)) continue;
    const auto length = channel.topic.size() - kOfEachVehicle.size();
    spaces.insert(length == 0 ? "/" : channel.topic.substr(0, length));
  }
  if (spaces.empty() || spaces.contains("/")) return space;
  if (spaces.size() == 1) return *spaces.begin();
  return fail(ErrorCode::invalid_parameter,
              fmt::format("several vehicles were recorded: name one with --namespace ({})",
                          fmt::join(spaces, ", ")));
}

int why_recorded(const WhyOptions& o, const Console& console) {
  auto reader = recording::Reader::open(recording_in(o.recording));
  if (!reader) return console.failed(reader.error());
  const auto space = space_in(*reader, o.vehicle.space);
  if (!space) return console.wrong_call(space.error());
  const double length_s = double(reader->end_ns() - reader->start_ns()) * 1e-9;
  const double at_s = o.at_s.value_or(length_s);
  if (at_s > length_s) {
    return console.wrong_call(
        {ErrorCode::invalid_parameter,
         fmt::format("--at {:g}: the recording lasts {:.2f} s", at_s, length_s)});
  }
  const std::uint64_t until_ns = reader->start_ns() + std::uint64_t(at_s * 1e9);
  why::SnapshotCollector collector;
  if (auto status = collector.read(*reader, *space, until_ns); !status) {
    return console.failed(status.error());
  }
  return tell(collector.snapshot(std::int64_t(until_ns)), console);
}

int why_live(const WhyOptions& o, const Console& console) {
  const auto space = introspection::full_topic_name(o.vehicle.space);
  if (!space) return console.failed(space.error());
  auto session = introspection::Session::open();
  if (!session) return console.failed(session.error());
  why::SnapshotCollector collector;
  collector.listen((*session)->node(), *space);
  (*session)->wait_for(o.vehicle.ready_s, [&] { return collector.is_complete(); });
  // What is latched has come by now; what is silent shows.
  (*session)->wait_for(1.2 * why::kSilent_s, [] { return false; });
  if (introspection::Interruptible::interrupted()) {
    return console.not_done({ErrorCode::cancelled, "interrupted"});
  }
  return tell(collector.snapshot((*session)->node().now_ns()), console);
}

}  // namespace

void add_why(Program& program) {
  const Verb verb = program.verb(
      "why",
      "what the vehicle does, and the one thing that keeps it from moving or from flying "
      "faster");
  auto o = std::make_shared<WhyOptions>();
  verb->add_option("recording", o->recording,
                   "a flight folder or a recording; none: the flight that runs");
  verb->add_option("--at", o->at_s, "[s] moment of the recording (default: its end)")
      ->check(CLI::Range(0.0, 1e9))
      ->needs("recording");
  verb->add_option("--namespace", o->vehicle.space, "of the vehicle, as /uav1")
      ->capture_default_str();
  verb->add_option("--ready", o->vehicle.ready_s, "[s] longest wait for the flight to be found")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  verb->footer(
      "Examples:\n"
      "  goshawk why\n"
      "  goshawk why flights/2026-11-30_12-00-00 --at 3.5 --json");
  verb.runs([o](const Console& console) {
    return o->recording.empty() ? why_live(*o, console) : why_recorded(*o, console);
  });
}

}  // namespace goshawk::cli
