#include <fmt/format.h>

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

template <typename Message>
Result<Message> decoded(const recording::MessageView& view) {
  Message m;
  if (runtime::decode<Message>({view.data.begin(), view.data.end()}, m)) return m;
  return fail(ErrorCode::invalid_input, "a message of the map cannot be decoded");
}

/// Reads one recording.
class Growth {
 public:
  explicit Growth(std::uint64_t start_ns) : start_ns_(start_ns) {}

  Status take_map(const recording::MessageView& view) {
    const auto m = decoded<goshawk_msgs::msg::VoxelGrid>(view);
    if (!m) return m.error();
    auto grid = conversions::from_msg(*m);
    if (!grid) return grid.error();
    maps_.take(seconds(view), *std::move(grid));
    return success();
  }

  Status take_update(const recording::MessageView& view) {
    const auto m = decoded<goshawk_msgs::msg::VoxelGridUpdate>(view);
    if (!m) return m.error();
    const auto update = conversions::from_msg(*m);
    return update ? maps_.take(seconds(view), *update) : Status(update.error());
  }

  void take_odometry(const recording::MessageView& view) {
    const auto m = decoded<nav_msgs::msg::Odometry>(view);
    const auto state = m ? conversions::from_msg(*m) : m.error();
    if (state) track_.emplace_back(seconds(view), state->position_map);
  }

  std::vector<MapMoment> moments(std::size_t count) const {
    auto moments = flight_report::spread(maps_.moments(), count);
    for (MapMoment& moment : moments) {
      for (const auto& [t_s, place] : track_) {
        if (t_s <= moment.t_s) moment.track_map.push_back(place);
      }
    }
    return moments;
  }

 private:
  double seconds(const recording::MessageView& view) const {
    return 1e-9 * double(view.log_time_ns - start_ns_);
  }

  std::uint64_t start_ns_;
  flight_report::MapTimeline maps_;
  std::vector<std::pair<double, Vec3>> track_;  // [s], [m]
};

Result<std::vector<MapMoment>> read_moments(const PictureOptions& o) {
  auto reader = recording::Reader::open(o.recording);
  if (!reader) return reader.error();
  const auto maps = channel_of(*reader, "map/voxels"), odometry = channel_of(*reader, "odom"),
             updates = channel_of(*reader, "map/voxels/updates");
  if (!maps || reader->message_count(*maps) == 0) {
    return fail(ErrorCode::invalid_input,
                "the recording has no map/voxels: record a flight with its topics");
  }
  recording::ReadOptions what;
  what.channels.emplace(std::set{*maps});
  if (updates) what.channels->insert(*updates);
  if (odometry) what.channels->insert(*odometry);
  if (auto same = recording::check_layout(*reader, *what.channels); !same) return same.error();

  Growth growth(reader->start_ns());
  Status fault = success();
  const auto read = reader->read(what, [&](const recording::MessageView& view) {
    if (view.channel_id == *maps) {
      fault = growth.take_map(view);
    } else if (view.channel_id == updates) {
      fault = growth.take_update(view);
    } else {
      growth.take_odometry(view);
    }
    return fault.ok();
  });
  if (!read) return read.error();
  if (!fault) return fault.error();
  return growth.moments(std::size_t(o.panels));
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
