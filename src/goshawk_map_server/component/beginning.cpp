#include "beginning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace goshawk::map_server {
namespace {

// Versions that an earlier life may have published and its journal does not have, because those
// scans changed nothing or their bricks were not written: months of scans.
constexpr std::uint64_t kVersionsToSpare = 1'000'000'000;

/// What a map begins with before any journal. @return without a file: the box, as unknown space
Result<std::optional<MapSource>> read_file(const Config& config) {
  if (config.follow_vehicle && !config.use_box) {
    return fail(ErrorCode::invalid_parameter,
                "follow_vehicle needs use_box: the box is the window that moves");
  }
  if (config.map_file.empty()) {
    if (config.use_box) return std::optional<MapSource>();
    return fail(ErrorCode::invalid_parameter,
                "map_server has neither a map_file nor use_box: name a map, or the box that begins "
                "as unknown space");
  }
  LoadOptions loading = load_options(config);
  if (config.follow_vehicle) loading.box = {};  // what lies outside is kept beside the window
  auto source = load_map(config.map_file, loading);
  if (!source) return source.error();
  return std::optional<MapSource>(*std::move(source));
}

Result<Beginning> begin_with(const std::optional<MapSource>& source, const Config& config) {
  const auto options = live_options(config);
  if (!options) return options.error();
  const VoxelizeOptions what = voxelize_options(config);
  auto map = source ? LiveMap::from_source(*source, what, growth(config), *options)
                    : LiveMap::unknown_space(what.box.value(), config.resolution_m, growth(config),
                                             *options);
  if (!map) return map.error();
  Beginning beginning{.map = *std::move(map)};
  if (source) beginning.notes = source->notes;
  return beginning;
}

/// The map before the first scan, as bits: what a journal goes with.
Result<RawVoxels> base_of(const std::optional<MapSource>& source, const Config& config) {
  VoxelizeOptions what = voxelize_options(config);
  if (source) {
    if (config.follow_vehicle) what.box = {};
    return voxelize(*source, what);
  }
  const auto geometry = raster_of(what.box.value(), config.resolution_m, config.max_voxels);
  if (!geometry) return geometry.error();
  return RawVoxels{*geometry, BitGrid(geometry->size, true), BitGrid(geometry->size, false)};
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

/// The map with what the journal holds. One that follows also keeps bricks outside of its window.
Result<Beginning> take_over(const RawVoxels& base, const JournalContent& content,
                            const std::optional<MapSource>& source, const Config& config) {
  MapSource with_journal;
  if (source) with_journal.notes = source->notes;
  with_journal.voxels = base;
  if (config.follow_vehicle) {
    auto wide = content.widened(base, config.max_voxels);
    if (!wide) return wide.error();
    with_journal.voxels = *std::move(wide);
  }
  content.write_into(*with_journal.voxels);
  auto beginning = begin_with(with_journal, config);
  if (beginning) beginning->bricks = content.bricks.size();
  return beginning;
}

Error damage_of(const JournalContent& content, const Config& config) {
  return told(config,
              {ErrorCode::map_malformed,
               fmt::format("{} bricks were damaged or cut off, or are of a scan with such a brick",
                           content.damaged)},
              fmt::format("They are left out; {} bricks are whole", content.bricks.size()));
}

/// What no earlier life has used: the clock is ahead of all, unless it was set back.
std::uint64_t unused_version(std::uint64_t in_journal, std::int64_t now_ns) {
  const auto now_ms = std::uint64_t(std::max<std::int64_t>(now_ns, 0) / 1'000'000);
  return std::max(now_ms, in_journal + kVersionsToSpare);
}

/// The next life finds this version, even if no scan changes the map any more.
Status note_version(MapJournal& journal, std::uint64_t version) {
  if (journal.content().bricks.empty()) return success();
  return journal.append(version, {&journal.content().bricks.begin()->second, 1});
}

/// With what the journal holds, if that can be; else without, and `fault` says so.
Result<Beginning> begin_with_content(const JournalContent& content, const RawVoxels& base,
                                     const std::optional<MapSource>& source, const Config& config,
                                     std::optional<Error>& fault) {
  if (content.damaged > 0) fault = damage_of(content, config);
  if (content.bricks.empty()) return begin_with(source, config);
  auto beginning = take_over(base, content, source, config);
  if (beginning) return beginning;
  fault = told(config, beginning.error(), "The map begins as it was before the first scan");
  return begin_with(source, config);
}

Result<Beginning> begin_with_journal(std::optional<MapSource> source, const Config& config,
                                     std::int64_t now_ns) {
  const auto base = base_of(source, config);
  if (!base) return base.error();
  if (source) {  // its bits are shared: nothing is read or voxelized again
    source->voxels = *base;
    source->tree.reset();
  }
  std::error_code ignored;
  const bool is_new = !std::filesystem::exists(config.journal_file, ignored);
  std::optional<Error> fault;
  auto journal = open_journal(config, {base->geometry.resolution_m, checksum_of(*base)}, fault);
  if (!journal) {
    auto beginning = begin_with(source, config);
    if (!beginning) return beginning;
    beginning->versions_before = unused_version(0, now_ns);
    beginning->journal_fault = journal.error();
    return beginning;
  }
  auto beginning = begin_with_content(journal->content(), *base, source, config, fault);
  if (!beginning) return beginning;
  if (!is_new) {
    beginning->versions_before = unused_version(journal->content().version, now_ns);
    const Status noted = note_version(*journal, beginning->versions_before);
    if (!noted && !fault) fault = noted.error();
  }
  beginning->journal_fault = std::move(fault);
  journal->forget_content();
  beginning->journal = std::make_unique<JournalThread>(*std::move(journal));
  return beginning;
}

}  // namespace

Result<Beginning> begin_map(const Config& config, std::int64_t now_ns) {
  auto source = read_file(config);
  if (!source) return source.error();
  if (config.journal_file.empty()) return begin_with(*source, config);
  return begin_with_journal(*std::move(source), config, now_ns);
}

}  // namespace goshawk::map_server
