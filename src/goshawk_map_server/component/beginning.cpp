#include "beginning.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

namespace goshawk::map_server {
namespace {

// Published before the server died, but not yet in its journal: far fewer scans.
constexpr std::uint64_t kVersionsToSpare = 1000;

Box box_of(const Config& c) {
  return {Vec3(c.box_x_min_m, c.box_y_min_m, c.box_z_min_m),
          Vec3(c.box_x_max_m, c.box_y_max_m, c.box_z_max_m)};
}

Result<Beginning> from(MapSource source, const Config& config) {
  const auto options = live_options(config);
  if (!options) return options.error();
  auto map = LiveMap::from_source(source, voxelize_options(config), growth(config), *options);
  if (!map) return map.error();
  return Beginning{.map = *std::move(map), .notes = std::move(source.notes)};
}

/// Without a journal.
Result<Beginning> begin_plain(const Config& config) {
  if (config.follow_vehicle && !config.use_box) {
    return fail(ErrorCode::invalid_parameter,
                "follow_vehicle needs use_box: the box is the window that moves");
  }
  if (!config.map_file.empty()) {
    LoadOptions loading = load_options(config);
    if (config.follow_vehicle) loading.box = {};  // what lies outside is kept beside the window
    auto source = load_map(config.map_file, loading);
    if (!source) return source.error();
    return from(*std::move(source), config);
  }
  if (!config.use_box) {
    return fail(ErrorCode::invalid_parameter,
                "map_server has neither a map_file nor use_box: name a map, or the box that begins "
                "as unknown space");
  }
  const auto options = live_options(config);
  if (!options) return options.error();
  auto map =
      LiveMap::unknown_space(box_of(config), config.resolution_m, growth(config), *options);
  if (!map) return map.error();
  return Beginning{.map = *std::move(map)};
}

Error told(const Config& config, const Error& why, const std::string& what_now) {
  return fail(why.code, fmt::format("the journal of the map '{}': {}. {}", config.journal_file,
                                    why.message, what_now));
}

/// An old file that is not this map's journal is put aside.
Result<MapJournal> open_journal(const Config& config, const JournalIdentity& identity,
                                std::optional<Error>& fault) {
  auto journal = MapJournal::open(config.journal_file, identity);
  if (journal || journal.code() == ErrorCode::io_failed) return journal;
  const std::string aside = config.journal_file + ".refused";
  fault = told(config, journal.error(), fmt::format("It is now '{}', and a new one begins", aside));
  std::error_code error;
  std::filesystem::rename(config.journal_file, aside, error);
  if (error) return fail(ErrorCode::io_failed, error.message());
  return MapJournal::create(config.journal_file, identity);
}

/// A map that follows keeps what lies outside of its window: the rest of the file, and bricks.
Result<RawVoxels> whole_of(RawVoxels window, const JournalContent& content, const Config& config) {
  if (!config.follow_vehicle) return window;
  if (!config.map_file.empty()) {
    LoadOptions loading = load_options(config);
    loading.box = {};
    const auto source = load_map(config.map_file, loading);
    if (!source) return source.error();
    auto voxels = voxelize(*source, {});
    if (!voxels) return voxels.error();
    window = *std::move(voxels);
  }
  return content.widened(window, config.max_voxels);
}

/// The map with what the journal holds.
Result<Beginning> take_over(RawVoxels window, const MapJournal& journal, const Config& config,
                            std::vector<std::string> notes) {
  auto whole = whole_of(std::move(window), journal.content(), config);
  if (!whole) return whole.error();
  RawVoxels voxels = *std::move(whole);
  journal.content().write_into(voxels);
  MapSource source;
  source.voxels = std::move(voxels);
  auto beginning = from(std::move(source), config);
  if (!beginning) return beginning;
  beginning->notes = std::move(notes);
  beginning->bricks = journal.content().bricks.size();
  return beginning;
}

}  // namespace

Result<Beginning> begin_map(const Config& config) {
  auto beginning = begin_plain(config);
  if (!beginning || config.journal_file.empty()) return beginning;
  const VoxelGrid grid = beginning->map.grid();
  RawVoxels voxels{grid.geometry, grid.raw, grid.known};
  std::optional<Error> fault;
  auto journal =
      open_journal(config, {grid.geometry.resolution_m, checksum_of(voxels)}, fault);
  if (!journal) {
    beginning->journal_fault = journal.error();
    return beginning;
  }
  const JournalContent& content = journal->content();
  const std::uint64_t version = content.version;
  if (content.damaged > 0) {
    fault = told(config, {ErrorCode::map_malformed,
                          fmt::format("{} entries were damaged or cut off", content.damaged)},
                 fmt::format("They are left out; {} bricks are whole", content.bricks.size()));
  }
  if (!content.bricks.empty()) {
    auto with_journal = take_over(std::move(voxels), *journal, config, beginning->notes);
    if (with_journal) {
      beginning = std::move(with_journal);
    } else {
      fault = told(config, with_journal.error(), "The map begins as it was before the first scan");
    }
  }
  beginning->versions_before = version > 0 ? version + kVersionsToSpare : 0;
  beginning->journal_fault = std::move(fault);
  journal->forget_content();
  beginning->journal = std::make_unique<JournalThread>(*std::move(journal));
  return beginning;
}

}  // namespace goshawk::map_server
