#include <fmt/format.h>

#include <optional>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/introspection/session.hpp"
#include "goshawk/introspection/topic_reader.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/map_summary.hpp"
#include "goshawk/map_server/map_tools.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/map_server_messages/octomap.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "goshawk_msgs.h"
#include "json.hpp"
#include "octomap_msgs.h"
#include "values.hpp"
#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

using map_server::RawVoxels;

constexpr std::int64_t kMostVoxels = map_server::VoxelizeOptions{}.max_voxels;

/// A map file's voxels, and a sentence about what was read.
struct ReadMap {
  RawVoxels voxels;
  std::string summary;
};

/// How files are read that do not say it themselves.
struct Reading {
  map_server::LoadOptions load;

  Result<ReadMap> read(const std::string& path, const Console& console) const {
    const auto source = map_server::load_map(path, load);
    if (!source) return source.error();
    for (const std::string& note : source->notes) console.say(path + ": " + note);
    auto voxels = map_server::voxelize(*source, {.box = load.box});
    if (!voxels) return voxels.error();
    std::string summary = map_server::summarise(*source, *voxels);
    return ReadMap{*std::move(voxels), std::move(summary)};
  }
};

void add_resolution(const Verb& verb, Reading& reading) {
  verb->add_option("--resolution", reading.load.resolution_m,
                   "[m] voxel edge for files that have none: .pcd, .ply, .stl, .obj, .3dmap")
      ->capture_default_str();
}

Json describe(const RawVoxels& map) {
  const GridGeometry& g = map.geometry;
  const std::int64_t known = map.known.count(), occupied = map.occupied.count();
  return {{"resolution_m", g.resolution_m},
          {"size_voxels", {g.size.x, g.size.y, g.size.z}},
          {"lower_m", to_json(g.origin_map)},
          {"upper_m", to_json(g.upper_corner_map())},
          {"occupied_voxels", occupied},
          {"free_voxels", known - occupied},
          {"unknown_voxels", g.size.x * std::int64_t{g.size.y} * g.size.z - known}};
}

/// What every verb that tells of a map ends with.
/// @param file that was read or written @param summary of the map
int tell(const std::string& file, const RawVoxels& map, const std::string& summary,
         const Console& console) {
  if (console.json()) {
    Json object = ok_json();
    object["file"] = file;
    object.update(describe(map));
    console.print(object);
  } else {
    fmt::print("{}: {}\n", file, summary);
  }
  return kDone;
}

int write(const RawVoxels& map, const std::string& output, const Console& console) {
  const auto cut = map_server::trimmed(map);
  if (!cut) return console.failed(cut.error());
  const auto saved = map_server::save_voxels(cut->geometry, cut->occupied, cut->known, output);
  if (!saved) return console.not_done(saved.error());
  return tell(output, *cut, map_server::summarise(*cut), console);
}

CLI::Option* add_output(const Verb& verb, std::string& output) {
  return verb->add_option("output", output, "file to write: .bt or .ot")->required();
}

void add_info(const Verb& map) {
  struct Options {
    std::string file;
    Reading reading;
  };
  const Verb verb = map.word("info", "size, place and content of a map file");
  auto o = std::make_shared<Options>();
  verb->add_option("file", o->file, "MAP: .bt, .ot, .pcd, .ply, .stl, .obj, .3dmap")->required();
  add_resolution(verb, o->reading);
  verb->footer("Example:\n  goshawk map info office.bt");
  verb.runs([o](const Console& console) {
    const auto read = o->reading.read(o->file, console);
    return read ? tell(o->file, read->voxels, read->summary, console)
                : console.failed(read.error());
  });
}

void add_crop(const Verb& map) {
  struct Options {
    std::string file, output;
    Vec3 lower_m = Vec3::Zero(), upper_m = Vec3::Zero();
    Reading reading;
  };
  const Verb verb = map.word("crop", "what a map file knows of a box");
  auto o = std::make_shared<Options>();
  verb->add_option("file", o->file, "MAP to read")->required();
  add_output(verb, o->output);
  add_point(verb, "--lower", o->lower_m, "[m] lower corner of the box")->required();
  add_point(verb, "--upper", o->upper_m, "[m] its upper corner")->required();
  add_resolution(verb, o->reading);
  verb->footer("Example:\n  goshawk map crop office.bt room.bt --lower 0,0,0 --upper 8,6,3");
  verb.runs([o](const Console& console) {
    o->reading.load.box = map_server::Box{o->lower_m, o->upper_m};
    const auto read = o->reading.read(o->file, console);
    return read ? write(read->voxels, o->output, console) : console.failed(read.error());
  });
}

Result<std::vector<RawVoxels>> read_all(const Words& files, const Reading& reading,
                                        const Console& console) {
  std::vector<RawVoxels> maps;
  for (const std::string& file : files) {
    auto read = reading.read(file, console);
    if (!read) return read.error();
    maps.push_back(std::move(read->voxels));
  }
  return maps;
}

void add_merge(const Verb& map) {
  struct Options {
    std::string output, rule = "occupied";
    Words files;
    Reading reading;
  };
  const Verb verb = map.word("merge", "one map of several");
  auto o = std::make_shared<Options>();
  add_output(verb, o->output);
  verb->add_option("files", o->files, "MAPs to read, the oldest first")->required();
  verb.choice("--rule", o->rule,
              "a voxel that several maps know: occupied (if it is in any of them), or later (as in "
              "the last one)",
              {"occupied", "later"})
      ->capture_default_str();
  add_resolution(verb, o->reading);
  verb->footer("Example:\n  goshawk map merge both.bt monday.bt tuesday.bt --rule later");
  verb.runs([o](const Console& console) {
    const auto maps = read_all(o->files, o->reading, console);
    if (!maps) return console.failed(maps.error());
    const auto rule = from_word<map_server::MergeRule>(o->rule);
    const auto all = map_server::merge(*maps, rule.value(), kMostVoxels);
    return all ? write(*all, o->output, console) : console.failed(all.error());
  });
}

int tell(const map_server::MapDifference& d, const Console& console) {
  if (console.json()) {
    Json object = ok_json();
    object.update({{"same", !d.any()},
                   {"same_voxels", d.same},
                   {"appeared_voxels", d.appeared},
                   {"vanished_voxels", d.vanished},
                   {"learnt_voxels", d.learnt},
                   {"forgotten_voxels", d.forgotten}});
    console.print(object);
  } else if (!d.any()) {
    fmt::print("both say the same of {} voxels\n", d.same);
  } else {
    fmt::print("{} voxels became occupied, {} free, {} known, {} unknown; {} are the same\n",
               d.appeared, d.vanished, d.learnt, d.forgotten, d.same);
  }
  return kDone;
}

void add_diff(const Verb& map) {
  struct Options {
    Words files;
    Reading reading;
  };
  const Verb verb = map.word("diff", "what changed from one map file to another");
  auto o = std::make_shared<Options>();
  verb->add_option("files", o->files, "two MAPs: before and after")->required()->expected(2);
  add_resolution(verb, o->reading);
  verb->footer("Example:\n  goshawk map diff monday.bt tuesday.bt");
  verb.runs([o](const Console& console) {
    const auto maps = read_all(o->files, o->reading, console);
    if (!maps) return console.failed(maps.error());
    const auto d = map_server::difference(maps->front(), maps->back(), kMostVoxels);
    return d ? tell(*d, console) : console.failed(d.error());
  });
}

/// How a map server that runs is found.
struct Server {
  std::string space = "/";
  double timeout_s = 10.0;

  std::string topic(const char* name) const { return (space == "/" ? "" : space) + "/" + name; }
};

/// What comes first on a topic with maps.
Result<RawVoxels> listen(const std::string& topic, double timeout_s, const Console& console) {
  auto session = introspection::Session::open();
  if (!session) return session.error();
  introspection::ReadOptions options;
  options.topic = topic;
  options.count = 1;
  options.timeout_s = timeout_s;
  Result<RawVoxels> map =
      fail(ErrorCode::stage_silent, fmt::format("no map came on {} in {:g} s", topic, timeout_s));
  introspection::TopicListener listener;
  listener.note = [&](const std::string& note) { console.say(note); };
  listener.message = [&](const introspection::RawMessage& message) {
    octomap_msgs::msg::Octomap m;
    map = runtime::decode(message.bytes, m)
              ? map_server::read_octomap(m)
              : fail(ErrorCode::invalid_input, topic + " does not hold octomap_msgs/msg/Octomap");
    return false;
  };
  if (auto status = introspection::read_topic(**session, options, listener); !status) {
    return status.error();
  }
  return map;
}

/// All that a map server knows; of one that does not tell, what its window holds.
Result<RawVoxels> map_of(const Server& server, const Console& console) {
  auto world = listen(server.topic("octomap_world"), server.timeout_s, console);
  if (world) return world;
  auto window = listen(server.topic("octomap_binary"), server.timeout_s, console);
  if (window) console.say("octomap_world is silent: the file holds the map's window only");
  return window;
}

void add_server(const Verb& verb, Server& server) {
  verb->add_option("--namespace", server.space, "of the vehicle, as /uav1")->capture_default_str();
  add_timeout(verb, server.timeout_s);
}

void add_save(const Verb& map) {
  struct Options {
    std::string output;
    Server server;
  };
  const Verb verb = map.word("save", "write the map that a running map server has now");
  auto o = std::make_shared<Options>();
  add_output(verb, o->output);
  add_server(verb, o->server);
  verb->footer(
      "What left a window that follows the vehicle is in it too.\n"
      "A flight begins in it with: goshawk launch live -p map_server:map_file:=hall.bt\n"
      "Example:\n  goshawk map save hall.bt");
  verb.runs([o](const Console& console) {
    const auto now = map_of(o->server, console);
    return now ? write(*now, o->output, console) : console.failed(now.error());
  });
}

/// Sends a map to a map server that runs. @return its refusal; stage_silent
Status send(const RawVoxels& map, const Server& server) {
  namespace roles = goshawk_msgs::msg::StageReport_Constants;
  auto session = introspection::Session::open();
  if (!session) return session.error();
  runtime::Node& node = (*session)->node();
  const auto maps = node.advertise<octomap_msgs::msg::Octomap>(server.topic("octomap_in"),
                                                               runtime::Qos::reliable_last(1));
  octomap_msgs::msg::Octomap m;
  m.header(conversions::make_header(node.now_ns()));
  if (auto s = map_server::fill_octomap(map.geometry, map.occupied, map.known, m); !s) return s;
  const auto request_id = std::uint64_t(conversions::to_ns(m.header().stamp()));
  std::optional<Status> answer;
  node.subscribe<goshawk_msgs::msg::StageReport>(
      server.topic("stage_report"), runtime::Qos::latched(20),
      [&](const goshawk_msgs::msg::StageReport& r, const auto&) {
        if (r.stage() != roles::STAGE_MAP_SERVER || r.request_id() != request_id) return;
        const ErrorCode code = conversions::error_code_of(r.code());
        answer = code == ErrorCode::ok ? success() : Status(fail(code, r.message()));
      });
  if (!(*session)->wait_for(server.timeout_s, [&] { return maps.matched() > 0; })) {
    return fail(
        ErrorCode::stage_silent,
        fmt::format("no map server reads {} in domain {} (waited {:g} s). Is one running, "
                    "with the same ROS_DOMAIN_ID and namespace?",
                    server.topic("octomap_in"), (*session)->context().domain(), server.timeout_s));
  }
  if (auto s = maps.publish(m); !s) return s;
  (*session)->wait_for(server.timeout_s, [&] { return answer.has_value(); });
  return answer.value_or(fail(ErrorCode::stage_silent,
                              fmt::format("the map server did not answer within {:g} s: it may "
                                          "still take the map",
                                          server.timeout_s)));
}

void add_load(const Verb& map) {
  struct Options {
    std::string file;
    Reading reading;
    Server server;
  };
  const Verb verb = map.word("load", "give a map file to a running map server");
  auto o = std::make_shared<Options>();
  verb->add_option("file", o->file, "MAP with voxels of the map server's size")->required();
  add_resolution(verb, o->reading);
  add_server(verb, o->server);
  verb->footer(
      "What the file knows takes the place of what the map server knew there; the rest stays.\n"
      "Example:\n  goshawk map load hall.bt");
  verb.runs([o](const Console& console) {
    const auto read = o->reading.read(o->file, console);
    if (!read) return console.failed(read.error());
    if (auto s = send(read->voxels, o->server); !s) return console.not_done(s.error());
    return tell(o->file, read->voxels, read->summary, console);
  });
}

}  // namespace

void add_map(Program& program) {
  const Verb map =
      program.verb("map", "map files: look at, cut, join, compare, draw; save and load a live map");
  add_info(map);
  add_save(map);
  add_load(map);
  add_map_picture(map);
  add_crop(map);
  add_merge(map);
  add_diff(map);
}

}  // namespace goshawk::cli
