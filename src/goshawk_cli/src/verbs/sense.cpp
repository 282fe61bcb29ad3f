#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <set>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/map_server/frame_tree.hpp"
#include "goshawk/map_server/sensor_check.hpp"
#include "goshawk/map_server_messages/cloud.hpp"
#include "goshawk/recording/reader.hpp"
#include "goshawk/recording_tools/layout.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "json.hpp"
#include "nav_msgs.h"
#include "sensor_msgs.h"
#include "tf2_msgs.h"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

using map_server::MountReport;
using map_server::SensorReport;
using sensor_msgs::msg::PointCloud2;

constexpr std::size_t kMostPoints = 10'000'000;
constexpr double kKept_s = 86'400.0, kMostGap_s = 0.5;
constexpr double kDegree = std::numbers::pi / 180.0;

struct SenseOptions {
  std::string recording, topic;
  double seconds = 60.0;
  map_server::SensorCheckOptions check;
};

/// What a recording says about a sensor.
struct Recorded {
  std::string topic, frame, fields;
  std::vector<map_server::RecordedCloud> clouds;
  map_server::PoseBuffer odometry{"odometry", kKept_s, kMostGap_s};
  map_server::FrameTree frames{kKept_s, kMostGap_s};
  std::optional<Error> refused;  // why clouds were left out
  std::int64_t left_out = 0;
};

struct JudgedSensor {
  SensorReport sensor;
  Result<MountReport> mount;
};

/// The channel of the clouds: the one that is asked for, or the only one.
Result<recording::Channel> find_clouds(const recording::Reader& reader, const std::string& topic) {
  std::vector<recording::Channel> found;
  std::string names;
  for (const auto& [id, channel] : reader.channels()) {
    const auto* schema = reader.schema_of(channel);
    if (schema == nullptr || schema->name != "sensor_msgs/msg/PointCloud2") continue;
    if (!topic.empty() && channel.topic != topic && !channel.topic.ends_with("/" + topic)) continue;
    found.push_back(channel);
    names += (names.empty() ? "" : ", ") + channel.topic;
  }
  if (found.size() == 1) return found.front();
  if (found.empty()) {
    return fail(ErrorCode::invalid_input,
                topic.empty() ? "the recording has no sensor_msgs/msg/PointCloud2: record a flight "
                                "with the sensor's topic"
                              : "the recording has no clouds on " + topic);
  }
  return fail(ErrorCode::invalid_input,
              "the recording has clouds on " + names + ": choose one with --topic");
}

void take_cloud(const recording::MessageView& view, Recorded& recorded) {
  PointCloud2 m;
  if (!runtime::decode<PointCloud2>({view.data.begin(), view.data.end()}, m)) return;
  map_server::RecordedCloud cloud;
  cloud.received_ns = std::int64_t(view.log_time_ns);
  cloud.claimed = std::int64_t{m.width()} * m.height();
  if (auto status = map_server::read_cloud(m, kMostPoints, cloud.cloud); !status) {
    recorded.refused = status.error();
    ++recorded.left_out;
    return;
  }
  if (recorded.clouds.empty()) {
    recorded.frame = m.header().frame_id();
    for (const auto& field : m.fields()) {
      recorded.fields += (recorded.fields.empty() ? "" : ", ") + field.name();
    }
  }
  recorded.clouds.push_back(std::move(cloud));
}

void take_odometry(const recording::MessageView& view, Recorded& recorded) {
  nav_msgs::msg::Odometry m;
  if (!runtime::decode<nav_msgs::msg::Odometry>({view.data.begin(), view.data.end()}, m)) return;
  if (const auto state = conversions::from_msg(m)) {
    // A clock that was set makes it begin anew; what is missing then is told as missing poses.
    (void)recorded.odometry.add(conversions::to_ns(m.header().stamp()),
                                {state->position_map, state->q_map_base});
  }
}

void take_frames(const recording::MessageView& view, Recorded& recorded) {
  tf2_msgs::msg::TFMessage m;
  if (!runtime::decode<tf2_msgs::msg::TFMessage>({view.data.begin(), view.data.end()}, m)) return;
  for (const auto& t : m.transforms()) {
    const auto q = conversions::from_msg(t.transform().rotation());
    const Vec3 p = conversions::from_msg(t.transform().translation());
    if (q && is_finite(p)) {
      recorded.frames.set_static(t.header().frame_id(), t.child_frame_id(), {p, *q});
    }
  }
}

Result<Recorded> read(const SenseOptions& o) {
  auto reader = recording::Reader::open(o.recording);
  if (!reader) return reader.error();
  const auto clouds = find_clouds(*reader, o.topic);
  if (!clouds) return clouds.error();
  Recorded recorded;
  recorded.topic = clouds->topic;
  recording::ReadOptions what;
  what.to_ns = reader->start_ns() + std::uint64_t(1e9 * o.seconds);
  what.channels.emplace(std::set<std::uint16_t>{clouds->id});
  std::set<std::uint16_t> odometry, frames;
  for (const auto& [id, channel] : reader->channels()) {
    if (channel.topic.ends_with("/odom")) odometry.insert(id);
    if (channel.topic == "/tf_static") frames.insert(id);
  }
  what.channels->insert(odometry.begin(), odometry.end());
  what.channels->insert(frames.begin(), frames.end());
  if (auto same = recording::check_layout(*reader, *what.channels); !same) return same.error();
  const auto status = reader->read(what, [&](const recording::MessageView& m) {
    if (m.channel_id == clouds->id) take_cloud(m, recorded);
    if (odometry.contains(m.channel_id)) take_odometry(m, recorded);
    if (frames.contains(m.channel_id)) take_frames(m, recorded);
    return true;
  });
  if (!status) return status.error();
  if (recorded.clouds.empty() && recorded.refused) return *recorded.refused;
  return recorded;
}

Result<MountReport> judge_mount(const Recorded& recorded, const SenseOptions& o) {
  const auto chain = recorded.frames.chain(recorded.frame, std::string(conversions::kBodyFrame));
  if (!chain) return chain.error();
  const auto mount = chain->at(recorded.clouds.front().cloud.stamp_ns);
  if (!mount) return mount.error();
  return map_server::check_mount(recorded.clouds, *mount, recorded.odometry, o.check.resolution_m);
}

Result<JudgedSensor> judge(const Recorded& recorded, const SenseOptions& o) {
  if (recorded.frame == conversions::kMapFrame) {
    return fail(ErrorCode::wrong_frame,
                "the clouds are in frame map already: record them in the sensor's own frame");
  }
  const auto sensor = map_server::check_sensor(recorded.clouds, o.check);
  if (!sensor) return sensor.error();
  return JudgedSensor{*sensor, judge_mount(recorded, o)};
}

Json describe(const Recorded& recorded, const JudgedSensor& judged) {
  const SensorReport& s = judged.sensor;
  Json blind = Json::array();
  for (const auto& sector : s.blind) {
    blind.push_back({sector.from_rad / kDegree, sector.to_rad / kDegree});
  }
  Json mount = {{"code", judged.mount ? "ok" : std::string(to_string(judged.mount.code()))},
                {"message", judged.mount ? "" : judged.mount.error().message}};
  if (judged.mount) {
    mount.update({{"suspicious", judged.mount->suspicious},
                  {"correction_deg", to_json(Vec3(judged.mount->correction_rad / kDegree))},
                  {"thinner_share", judged.mount->thinner_share}});
  }
  Json object = ok_json();
  object.update(
      {{"topic", recorded.topic},
       {"frame", recorded.frame},
       {"fields", recorded.fields},
       {"clouds", s.clouds},
       {"clouds_refused", recorded.left_out},
       {"refused_because", recorded.refused ? recorded.refused->message : ""},
       {"duration_s", s.duration_s},
       {"rate_hz", s.rate_hz},
       {"longest_gap_s", s.longest_gap_s},
       {"latency_mean_s", s.latency_mean_s},
       {"latency_max_s", s.latency_max_s},
       {"points", s.points},
       {"missing_share", s.missing_share},
       {"range_m", {s.range_least_m, s.range_median_m, s.range_most_m}},
       {"elevation_deg", {s.elevation_lower_rad / kDegree, s.elevation_upper_rad / kDegree}},
       {"blind_deg", blind},
       {"body_share", s.body_share},
       {"body_reach_m", s.body_reach_m},
       {"dense_range_m", s.dense_range_m},
       {"speed_m_s", s.speed_m_s},
       {"mount", mount}});
  return object;
}

std::string blind_words(const SensorReport& s) {
  if (s.blind.empty()) return "sees all around";
  std::string words = "blind";
  for (const auto& sector : s.blind) {
    words += fmt::format(" from {:.0f} to {:.0f} deg;", sector.from_rad / kDegree,
                         sector.to_rad / kDegree);
  }
  words.back() = ' ';
  return words + "of azimuth";
}

std::string mount_words(const JudgedSensor& judged) {
  if (!judged.mount) return "not judged: " + judged.mount.error().message;
  const Vec3 degrees = judged.mount->correction_rad / kDegree;
  if (!judged.mount->suspicious) return "no double walls";
  return fmt::format(
      "walls are double: turned by {:.1f}, {:.1f}, {:.1f} deg (roll, pitch, yaw) "
      "they fill {:.0f} % fewer voxels; check the mount and the time stamps",
      degrees.x(), degrees.y(), degrees.z(), 100.0 * judged.mount->thinner_share);
}

void print_text(const Recorded& recorded, const JudgedSensor& judged) {
  const SensorReport& s = judged.sensor;
  fmt::print("{}: frame {}, fields {}\n", recorded.topic, recorded.frame, recorded.fields);
  fmt::print("clouds   {} in {:.1f} s: {:.2f} Hz, longest gap {:.2f} s\n", s.clouds, s.duration_s,
             s.rate_hz, s.longest_gap_s);
  if (recorded.left_out > 0) {
    fmt::print("refused  {}: {}\n", recorded.left_out, recorded.refused->message);
  }
  fmt::print("latency  mean {:.0f} ms, largest {:.0f} ms\n", 1e3 * s.latency_mean_s,
             1e3 * s.latency_max_s);
  fmt::print("points   {:.0f} a cloud, {:.0f} % missing\n", s.points, 100.0 * s.missing_share);
  fmt::print("range    {:.2f} to {:.1f} m, median {:.1f} m\n", s.range_least_m, s.range_most_m,
             s.range_median_m);
  fmt::print("view     {:.0f} to {:.0f} deg of elevation; {}\n", s.elevation_lower_rad / kDegree,
             s.elevation_upper_rad / kDegree, blind_words(s));
  fmt::print("body     {}\n",
             s.body_share > 0.0
                 ? fmt::format("{:.1f} % of the points, up to {:.2f} m away: set the map server's "
                               "body_radius_m above it",
                               100.0 * s.body_share, s.body_reach_m)
                 : "not in view");
  fmt::print("mount    {}\n", mount_words(judged));
  fmt::print("speed    {:.1f} m/s: walls are dense up to {:.1f} m\n", s.speed_m_s, s.dense_range_m);
}

void add_sense_check(const Verb& sense) {
  const Verb verb = sense.word("check", "what a recorded cloud topic tells of its sensor");
  auto o = std::make_shared<SenseOptions>();
  verb->add_option("recording", o->recording, "RECORDING.mcap")->required();
  verb->add_option("--topic", o->topic, "of the clouds (default: the only one)");
  verb->add_option("--seconds", o->seconds, "[s] of the recording that are read")
      ->check(CLI::Range(0.1, kKept_s))
      ->capture_default_str();
  verb->add_option("--resolution", o->check.resolution_m, "[m] voxel edge of the map")
      ->check(CLI::Range(1e-3, 100.0))
      ->capture_default_str();
  verb->add_option("--a-max", o->check.a_max_m_s2, "[m/s^2] with which the vehicle stops")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  verb->add_option("--margin", o->check.margin_m, "[m] kept from what it stops before")
      ->check(CLI::Range(0.0, 1e3))
      ->capture_default_str();
  verb->footer("Example:\n  goshawk sense check flight.mcap --topic points");
  verb.runs([o](const Console& console) {
    const auto recorded = read(*o);
    if (!recorded) return console.failed(recorded.error());
    const auto judged = judge(*recorded, *o);
    if (!judged) return console.failed(judged.error());
    if (console.json()) {
      console.print(describe(*recorded, *judged));
    } else {
      print_text(*recorded, *judged);
    }
    return kDone;
  });
}

}  // namespace

void add_sense(Program& program) {
  add_sense_check(program.verb("sense", "judge a sensor by a recording of it"));
}

}  // namespace goshawk::cli
