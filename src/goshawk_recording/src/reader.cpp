#include "goshawk/recording/reader.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <queue>

#include "block.hpp"

namespace goshawk::recording {
namespace {

constexpr std::uint64_t kMostOutside = 4 << 20;  // [byte] of messages outside chunks, read at once
constexpr std::uint64_t kMostDefinition = 64 << 20;  // [byte] of a schema or a channel
constexpr std::uint64_t kChunkHead = 64;             // [byte] chunk fields before the records

}  // namespace

struct Reader::Impl {
  explicit Impl(File f) : file(std::move(f)) {}

  File file;
  std::string profile;
  std::map<std::uint16_t, Schema> schemas;
  std::map<std::uint16_t, Channel> channels;
  std::vector<Block> blocks;
  std::map<std::uint16_t, std::uint64_t> counts;
  std::uint64_t total = 0, start_ns = 0, end_ns = 0;
  std::vector<std::string> complaints;
  bool complete = false;    // it has a footer and the final magic
  bool statistics = false;  // it has a count of messages
  bool outside = false;     // the previous record was a message outside chunks

  Status scan();
  Status take_record(Opcode opcode, std::uint64_t at, std::uint64_t size);
  Status take_small(Opcode opcode, std::uint64_t at, std::uint64_t size);
  Status take_chunk(std::uint64_t at, std::uint64_t size);
  Status take_message(std::uint64_t at, std::uint64_t size);
  void take_statistics(View content);
  void define(Opcode opcode, View content);
  Status count_all();
  void count(Block& block, View records);
  void complain(std::string sentence) {
    if (std::ranges::find(complaints, sentence) == complaints.end()) {
      complaints.push_back(std::move(sentence));
    }
  }
};

// Walks from record to record without unpacking chunks: the summary of a whole file repeats all
// definitions.
Status Reader::Impl::scan() {
  std::uint64_t at = kMagic.size();
  while (!complete) {
    if (at == file.size()) break;
    const auto head = file.read(at, kRecordHead);
    if (!head) return head.error();
    In in(*head);
    const auto opcode = Opcode(in.number<std::uint8_t>());
    const auto size = in.number<std::uint64_t>();
    if (!in.good() || size > file.size() - at - kRecordHead) break;
    if (opcode == Opcode{0}) break;  // not a record: zeros of a file system after a loss of power
    if (auto status = take_record(opcode, at + kRecordHead, size); !status) return status;
    at += kRecordHead + size;
  }
  if (complete && at + kMagic.size() > file.size()) complete = false;
  if (!complete) {
    complain(
        fmt::format("the recording is cut off after byte {} of {}: everything before that is read",
                    at, file.size()));
  }
  const bool defined = std::ranges::all_of(
      counts, [&](const auto& entry) { return channels.contains(entry.first); });
  return complete && statistics && defined ? success() : count_all();
}

Status Reader::Impl::take_record(Opcode opcode, std::uint64_t at, std::uint64_t size) {
  if (opcode != Opcode::message) outside = false;
  switch (opcode) {
    case Opcode::chunk:
      return take_chunk(at, size);
    case Opcode::message:
      return take_message(at, size);
    case Opcode::footer:
      complete = true;
      return success();
    case Opcode::header:
    case Opcode::schema:
    case Opcode::channel:
    case Opcode::statistics:
      return take_small(opcode, at, size);
    default:
      return success();  // indices, which are not trusted, and records of later versions
  }
}

Status Reader::Impl::take_small(Opcode opcode, std::uint64_t at, std::uint64_t size) {
  if (size > kMostDefinition) {
    complain(fmt::format("the record at byte {} exceeds the maximum length of its type", at));
    return success();
  }
  const auto content = file.read(at, size);
  if (!content) return content.error();
  if (opcode == Opcode::header) {
    profile = In(*content).text();
  } else if (opcode == Opcode::statistics) {
    take_statistics(*content);
  } else {
    define(opcode, *content);
  }
  return success();
}

void Reader::Impl::define(Opcode opcode, View content) {
  if (opcode == Opcode::schema) {
    if (auto schema = recording::schema_of(content)) return void(schemas[schema->id] = *schema);
  } else if (opcode == Opcode::channel) {
    if (auto channel = channel_of(content)) return void(channels[channel->id] = *channel);
  } else {
    return;
  }
  complain("a schema or a channel is damaged: its messages are skipped");
}

Status Reader::Impl::take_chunk(std::uint64_t at, std::uint64_t size) {
  const auto head = file.read(at, std::min(size, kChunkHead));
  if (!head) return head.error();
  if (const auto block = chunk_of(*head, at, size)) {
    blocks.push_back(*block);
  } else {
    complain(fmt::format("the chunk at byte {} is damaged and skipped", at));
  }
  return success();
}

Status Reader::Impl::take_message(std::uint64_t at, std::uint64_t size) {
  constexpr std::uint64_t kMessageHead = 22;  // [byte] before the data
  const auto head = file.read(at, std::min(size, kMessageHead));
  if (!head) return head.error();
  const auto message = message_of(*head);
  if (!message) {
    complain(fmt::format("the message at byte {} is damaged and skipped", at));
    outside = false;
    return success();
  }
  const std::uint64_t time_ns = message->log_time_ns;
  if (!outside || blocks.back().size > kMostOutside) {
    blocks.push_back({.offset = at - kRecordHead, .start_ns = time_ns, .end_ns = time_ns});
  }
  auto& block = blocks.back();
  block.size += kRecordHead + size;
  block.uncompressed_size = block.size;
  block.start_ns = std::min(block.start_ns, time_ns);
  block.end_ns = std::max(block.end_ns, time_ns);
  outside = true;
  return success();
}

void Reader::Impl::take_statistics(View content) {
  In in(content);
  const auto messages = in.number<std::uint64_t>();
  in.raw(2 + 4 * 4);  // numbers of schemas, channels, attachments, metadata, chunks
  const auto first_ns = in.number<std::uint64_t>();
  const auto last_ns = in.number<std::uint64_t>();
  In map(in.raw(in.number<std::uint32_t>()));
  std::map<std::uint16_t, std::uint64_t> by_channel;
  while (in.good() && map.good() && map.left() > 0) {
    const auto channel = map.number<std::uint16_t>();
    by_channel[channel] = map.number<std::uint64_t>();
  }
  if (!in.good() || !map.good()) return;  // messages are counted instead
  total = messages;
  start_ns = first_ns;
  end_ns = last_ns;
  counts = std::move(by_channel);
  statistics = true;
}

Status Reader::Impl::count_all() {
  counts.clear();
  total = 0;
  start_ns = ~0ULL;
  end_ns = 0;
  std::vector<Block> whole;
  for (auto& block : blocks) {
    auto records = load(file, block);
    if (!records && records.code() == ErrorCode::io_failed) return records.error();
    if (!records) {
      complain(records.error().message);
      continue;
    }
    count(block, *records);
    whole.push_back(block);
  }
  blocks = std::move(whole);
  if (total == 0) start_ns = 0;
  return success();
}

// Also finds the true first and last times: those in chunks may be wrong.
void Reader::Impl::count(Block& block, View records) {
  block.start_ns = ~0ULL;
  block.end_ns = 0;
  const bool whole = for_each_record(records, [&](Opcode opcode, View content) {
    const auto message = opcode == Opcode::message ? message_of(content) : std::nullopt;
    if (!message) return define(opcode, content);
    ++counts[message->channel_id];
    ++total;
    block.start_ns = std::min(block.start_ns, message->log_time_ns);
    block.end_ns = std::max(block.end_ns, message->log_time_ns);
  });
  if (!whole) {
    complain(fmt::format("the chunk at byte {} is cut off", block.offset));
  }
  start_ns = std::min(start_ns, block.start_ns);
  end_ns = std::max(end_ns, block.end_ns);
}

Reader::Reader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Reader::~Reader() = default;
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;

Result<Reader> Reader::open(const std::string& path) {
  auto file = File::open(path);
  if (!file) return file.error();
  auto impl = std::make_unique<Impl>(*std::move(file));
  const auto magic = impl->file.read(0, kMagic.size());
  if (!magic) return magic.error();
  if (!std::ranges::equal(*magic, kMagic)) {
    return fail(ErrorCode::invalid_input,
                path + " is not an MCAP recording: its first bytes are wrong");
  }
  if (auto status = impl->scan(); !status) return status.error();
  return Reader(std::move(impl));
}

const std::string& Reader::profile() const {
  return impl_->profile;
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
  void add(std::shared_ptr<const Bytes> records, const ReadOptions& options) {
    for_each_record(*records, [&](Opcode opcode, View content) {
      if (opcode != Opcode::message) return;
      const auto m = message_of(content);
      if (!m || m->log_time_ns < options.from_ns || m->log_time_ns > options.to_ns) return;
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
  std::vector<const Block*> blocks;
  for (const auto& block : impl_->blocks) {
    if (block.end_ns >= options.from_ns && block.start_ns <= options.to_ns) {
      blocks.push_back(&block);
    }
  }
  std::ranges::stable_sort(blocks, {}, [](const Block* b) { return b->start_ns; });
  Merge merge;
  for (const Block* block : blocks) {
    if (!merge.give_until(block->start_ns, false, take)) return success();
    auto records = load(impl_->file, *block);
    if (!records && records.code() == ErrorCode::io_failed) return records.error();
    if (!records) {
      impl_->complain(records.error().message);
      continue;
    }
    merge.add(std::make_shared<const Bytes>(*std::move(records)), options);
  }
  merge.give_until(0, true, take);
  return success();
}

}  // namespace goshawk::recording
