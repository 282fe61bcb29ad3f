#include <fmt/format.h>

#include "goshawk/introspection/topic_reader.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/map_summary.hpp"
#include "goshawk/map_server/map_tools.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/runtime/message_type.hpp"
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

Result<RawVoxels> decode(const std::vector<unsigned char>& bytes) {
  octomap_msgs::msg::Octomap m;
  if (!runtime::decode(bytes, m) || !m.binary() || m.id() != "OcTree") {
    return fail(ErrorCode::invalid_input, "octomap_binary does not hold a binary OcTree");
  }
  const std::string_view payload(reinterpret_cast<const char*>(m.data().data()), m.data().size());
  const auto tree = map_server::read_binary_payload(payload, m.resolution());
  if (!tree) return tree.error();
  return map_server::voxelize(**tree);
}

/// The map of a map server that runs.
Result<RawVoxels> listen(introspection::ReadOptions options, const Console& console) {
  auto session = introspection::Session::open();
  if (!session) return session.error();
  options.topic = "octomap_binary";
  options.count = 1;
  Result<RawVoxels> map = fail(ErrorCode::stage_silent, "no map came on octomap_binary");
  introspection::TopicListener listener;
  listener.note = [&](const std::string& note) { console.say(note); };
  listener.message = [&](const introspection::RawMessage& message) {
    map = decode(message.bytes);
    return false;
  };
  if (auto status = introspection::read_topic(**session, options, listener); !status) {
    return status.error();
  }
  return map;
}

void add_save(const Verb& map) {
  struct Options {
    std::string output;
    introspection::ReadOptions read;
  };
  const Verb verb = map.word("save", "write the map that a running map server has now");
  auto o = std::make_shared<Options>();
  o->read.timeout_s = 10.0;
  add_output(verb, o->output);
  add_timeout(verb, o->read.timeout_s);
  verb->footer(
      "A flight begins in it with: goshawk launch live -p map_server:map_file:=hall.bt\n"
      "Example:\n  goshawk map save hall.bt");
  verb.runs([o](const Console& console) {
    const auto now = listen(o->read, console);
    return now ? write(*now, o->output, console) : console.failed(now.error());
  });
}

}  // namespace

void add_map(Program& program) {
  const Verb map =
      program.verb("map", "map files: look at, cut, join and compare; save a live map");
  add_info(map);
  add_save(map);
  add_crop(map);
  add_merge(map);
  add_diff(map);
}

}  // namespace goshawk::cli
