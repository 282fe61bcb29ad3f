#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/flight_report/growth.hpp"
#include "goshawk/recording/reader.hpp"
#include "goshawk/recording_tools/layout.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "goshawk_msgs.h"
#include "json.hpp"
#include "nav_msgs.h"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

using flight_report::MapMoment;

struct PictureOptions {
  std::string recording, output;
  int panels = 4;
};

/// The first channel of a topic, in any namespace.
std::optional<std::uint16_t> channel_of(const recording::Reader& reader, const std::string& topic) {
  for (const auto& [id, channel] : reader.channels()) {
    if (channel.topic.ends_with("/" + topic)) return id;
  }
  return {};
}

/// Which of so many maps are drawn: the first, the last, and others evenly between.
std::set<std::uint64_t> chosen(std::uint64_t maps, int panels) {
  std::set<std::uint64_t> numbers{maps - 1};
  for (int k = 0; k + 1 < panels; ++k) {
    numbers.insert(std::uint64_t(std::llround(double(k) * double(maps - 1) / (panels - 1))));
  }
  return numbers;
}

Result<std::vector<MapMoment>> read_moments(const PictureOptions& o) {
  auto reader = recording::Reader::open(o.recording);
  if (!reader) return reader.error();
  const auto maps = channel_of(*reader, "map/voxels"), odometry = channel_of(*reader, "odom");
  if (!maps || reader->message_count(*maps) == 0) {
    return fail(ErrorCode::invalid_input,
                "the recording has no map/voxels: record a flight with its topics");
  }
  recording::ReadOptions what;
  what.channels.emplace(std::set{*maps});
  if (odometry) what.channels->insert(*odometry);
  if (auto same = recording::check_layout(*reader, *what.channels); !same) return same.error();

  const auto numbers = chosen(reader->message_count(*maps), o.panels);
  std::uint64_t number = 0;
  std::vector<Vec3> track;
  std::vector<MapMoment> moments;
  Status fault = success();
  const auto take_map = [&](const recording::MessageView& view) {
    if (!numbers.contains(number++)) return;
    goshawk_msgs::msg::VoxelGrid m;
    if (!runtime::decode<goshawk_msgs::msg::VoxelGrid>({view.data.begin(), view.data.end()}, m)) {
      fault = fail(ErrorCode::invalid_input, "a message of map/voxels cannot be decoded");
      return;
    }
    auto grid = conversions::from_msg(m);
    if (!grid) {
      fault = grid.error();
      return;
    }
    moments.push_back(
        {1e-9 * double(view.log_time_ns - reader->start_ns()), *std::move(grid), track});
  };
  const auto read = reader->read(what, [&](const recording::MessageView& view) {
    if (view.channel_id == *maps) {
      take_map(view);
      return fault.ok();
    }
    nav_msgs::msg::Odometry m;
    if (runtime::decode<nav_msgs::msg::Odometry>({view.data.begin(), view.data.end()}, m)) {
      if (const auto state = conversions::from_msg(m)) track.push_back(state->position_map);
    }
    return true;
  });
  if (!read) return read.error();
  if (!fault) return fault.error();
  return moments;
}

}  // namespace

void add_map_picture(const Verb& map) {
  const Verb verb = map.word("picture", "how the map of a recorded flight grew, as a PNG");
  auto o = std::make_shared<PictureOptions>();
  verb->add_option("recording", o->recording, "RECORDING.mcap with map/voxels and odom")
      ->required();
  verb->add_option("output", o->output, "file to write: .png")->required();
  verb->add_option("--panels", o->panels, "moments that are shown, evenly over the recording")
      ->check(CLI::Range(1, 12))
      ->capture_default_str();
  verb->footer(
      "Each panel shows the window from above at the heights flown, and in colour what was learnt\n"
      "since the panel before.\n"
      "Example:\n  goshawk map picture flight.mcap growth.png");
  verb.runs([o](const Console& console) {
    const auto moments = read_moments(*o);
    if (!moments) return console.failed(moments.error());
    if (auto s = flight_report::draw_growth(*moments, o->output); !s) {
      return console.not_done(s.error());
    }
    if (console.json()) {
      Json object = ok_json();
      object.update({{"file", o->output}, {"panels", moments->size()}});
      console.print(object);
    } else {
      fmt::print("{}: {} moments\n", o->output, moments->size());
    }
    return kDone;
  });
}

}  // namespace goshawk::cli
