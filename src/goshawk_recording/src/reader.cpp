#include "goshawk/recording/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <queue>

#include "folder.hpp"
#include "part.hpp"

namespace goshawk::recording {

using Ids = std::map<std::uint16_t, std::uint16_t>;  // of one part to those of the recording

struct Reader::Impl {
  std::vector<Part> parts;
  std::vector<Ids> channel_ids;         // of each part; the first keeps its own
  std::vector<std::string> names = {};  // of the parts' files, if there are several
  std::map<std::uint16_t, Schema> schemas = {};
  std::map<std::uint16_t, Channel> channels = {};
  std::map<std::uint16_t, std::uint64_t> counts = {};
  std::uint64_t total = 0, start_ns = 0, end_ns = 0;
  std::vector<std::string> complaints = {};

  Status add(Part part);
  void complain(std::size_t part, const std::string& sentence);
};

namespace {

/// The number in `known` of an entry that is `same`, else a new one. @return nothing: there is none
template <typename Entry, typename Same>
std::optional<std::uint16_t> number_of(const std::map<std::uint16_t, Entry>& known, int least,
                                       const Same& same) {
  const auto found =
      std::ranges::find_if(known, [&](const auto& entry) { return same(entry.second); });
  if (found != known.end()) return found->first;
  const int next = std::max(least, known.empty() ? 1 : known.rbegin()->first + 1);
  if (next > std::numeric_limits<std::uint16_t>::max()) return {};
  return std::uint16_t(next);
}

/// Where a part's channels are among those of the recording, to which they are added. @return
/// invalid_input if there are more than MCAP can number
Result<Ids> merge_channels(const Part& part, int least, std::map<std::uint16_t, Schema>& schemas,
                           std::map<std::uint16_t, Channel>& channels) {
  const Error too_many = fail(ErrorCode::invalid_input, "its files have more than 65535 channels");
  Ids schema_ids{{0, 0}}, ids;
  for (const auto& [id, part_schema] : part.schemas) {
    Schema schema = part_schema;
    const auto number = number_of(schemas, 1, [&](const Schema& other) {
      return other.name == schema.name && other.encoding == schema.encoding &&
             other.data == schema.data;
    });
    if (!number) return too_many;
    schema_ids[id] = schema.id = *number;
    schemas.emplace(*number, schema);
  }
  for (const auto& [id, part_channel] : part.channels) {
    Channel channel = part_channel;
    const auto schema = schema_ids.find(channel.schema_id);
    channel.schema_id = schema == schema_ids.end() ? std::uint16_t{0} : schema->second;
    const auto number = number_of(channels, least, [&](const Channel& other) {
      return other.topic == channel.topic && other.schema_id == channel.schema_id &&
             other.message_encoding == channel.message_encoding;
    });
    if (!number) return too_many;
    ids[id] = channel.id = *number;
    channels.emplace(*number, channel);
  }
  return ids;
}

/// A message's channel in the recording; one without a definition has none but in the first part.
std::optional<std::uint16_t> channel_of_recording(const Ids& ids, std::uint16_t id, bool first) {
  if (first) return id;
  const auto found = ids.find(id);
  return found == ids.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

Status Reader::Impl::add(Part part) {
  const bool first = parts.empty();
  Ids ids;
  if (first) {
    schemas = part.schemas;
    channels = part.channels;
  } else {
    // Beyond what the first part's messages call their channels, defined or not.
    const int least = counts.empty() ? 1 : counts.rbegin()->first + 1;
    auto merged = merge_channels(part, least, schemas, channels);
    if (!merged) return merged.error();
    ids = *std::move(merged);
  }
  for (const auto& [id, count] : part.counts) {
    if (const auto channel = channel_of_recording(ids, id, first)) counts[*channel] += count;
  }
  if (part.total > 0) {
    start_ns = total == 0 ? part.start_ns : std::min(start_ns, part.start_ns);
    end_ns = std::max(end_ns, part.end_ns);
  }
  total += part.total;
  parts.push_back(std::move(part));
  channel_ids.push_back(std::move(ids));
  for (const auto& sentence : parts.back().complaints) complain(parts.size() - 1, sentence);
  return success();
}

void Reader::Impl::complain(std::size_t part, const std::string& sentence) {
  std::string text = names.empty() ? sentence : fmt::format("{}: {}", names[part], sentence);
  if (std::ranges::find(complaints, text) == complaints.end()) {
    complaints.push_back(std::move(text));
  }
}

Reader::Reader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Reader::~Reader() = default;
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;

Result<Reader> Reader::open(const std::string& path) {
  const auto files = recording_files(path);
  if (!files) return files.error();
  auto impl = std::make_unique<Impl>();
  impl->complaints = files->complaints;
  for (const std::string& file : files->paths) {
    if (files->paths.size() > 1) impl->names.push_back(file.substr(file.rfind('/') + 1));
    auto part = Part::open(file);
    if (!part) return part.error();
    if (auto status = impl->add(*std::move(part)); !status) {
      return fail(status.code(),
                  fmt::format("{} cannot be read: {}", path, status.error().message));
    }
  }
  return Reader(std::move(impl));
}

const std::string& Reader::profile() const {
  return impl_->parts.front().profile;
}
const std::map<std::uint16_t, Schema>& Reader::schemas() const {
  return impl_->schemas;
}
const std::map<std::uint16_t, Channel>& Reader::channels() const {
  return impl_->channels;
}
const Schema* Reader::schema_of(const Channel& channel) const {
  const auto found = impl_->schemas.find(channel.schema_id);
  return found == impl_->schemas.end() ? nullptr : &found->second;
}
std::uint64_t Reader::message_count() const {
  return impl_->total;
}
std::uint64_t Reader::message_count(std::uint16_t channel_id) const {
  const auto found = impl_->counts.find(channel_id);
  return found == impl_->counts.end() ? 0 : found->second;
}
std::uint64_t Reader::start_ns() const {
  return impl_->start_ns;
}
std::uint64_t Reader::end_ns() const {
  return impl_->end_ns;
}
const std::vector<std::string>& Reader::complaints() const {
  return impl_->complaints;
}

namespace {

/// Messages of blocks that overlap in time, put in order.
class Merge {
 public:
  /// @param channel_of the recording's channel for one of these records, or none
  template <typename ChannelOf>
  void add(std::shared_ptr<const Bytes> records, const ReadOptions& options,
           const ChannelOf& channel_of) {
    for_each_record(*records, [&](Opcode opcode, View content) {
      if (opcode != Opcode::message) return;
      auto m = message_of(content);
      if (!m || m->log_time_ns < options.from_ns || m->log_time_ns > options.to_ns) return;
      const std::optional<std::uint16_t> channel = channel_of(m->channel_id);
      if (!channel) return;
      m->channel_id = *channel;
      if (options.channels && !options.channels->contains(m->channel_id)) return;
      items_.push({*m, order_++, records});
    });
  }

  /// @return whether take wants more
  bool give_until(std::uint64_t time_ns, bool all,
                  const std::function<bool(const MessageView&)>& take) {
    while (!items_.empty() && (all || items_.top().message.log_time_ns < time_ns)) {
      const Item item = items_.top();
      items_.pop();
      if (!take(item.message)) return false;
    }
    return true;
  }

 private:
  struct Item {
    MessageView message;
    std::uint64_t order;
    std::shared_ptr<const Bytes> owner;
    bool operator<(const Item& other) const {  // the earliest compares greatest
      return std::pair(message.log_time_ns, order) >
             std::pair(other.message.log_time_ns, other.order);
    }
  };
  std::priority_queue<Item> items_;
  std::uint64_t order_ = 0;
};

}  // namespace

Status Reader::read(const ReadOptions& options,
                    const std::function<bool(const MessageView&)>& take) {
  struct Place {
    std::size_t part;
    const Block* block;
  };
  std::vector<Place> places;
  for (std::size_t part = 0; part < impl_->parts.size(); ++part) {
    for (const auto& block : impl_->parts[part].blocks) {
      if (block.end_ns >= options.from_ns && block.start_ns <= options.to_ns) {
        places.push_back({part, &block});
      }
    }
  }
  std::ranges::stable_sort(places, {}, [](const Place& place) { return place.block->start_ns; });
  Merge merge;
  for (const Place& place : places) {
    if (!merge.give_until(place.block->start_ns, false, take)) return success();
    auto records = load(impl_->parts[place.part].file, *place.block);
    if (!records && records.code() == ErrorCode::io_failed) return records.error();
    if (!records) {
      impl_->complain(place.part, records.error().message);
      continue;
    }
    const Ids& ids = impl_->channel_ids[place.part];
    merge.add(std::make_shared<const Bytes>(*std::move(records)), options,
              [&](std::uint16_t id) { return channel_of_recording(ids, id, place.part == 0); });
  }
  merge.give_until(0, true, take);
  return success();
}

}  // namespace goshawk::recording
