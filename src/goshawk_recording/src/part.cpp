#include "part.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace goshawk::recording {
namespace {

constexpr std::uint64_t kMostOutside = 4 << 20;  // [byte] of messages outside chunks, read at once
constexpr std::uint64_t kMostDefinition = 64 << 20;  // [byte] of a schema or a channel
constexpr std::uint64_t kChunkHead = 64;             // [byte] chunk fields before the records

class Scanner {
 public:
  explicit Scanner(Part& part) : part_(part) {}
  Status scan();

 private:
  Status take_record(Opcode opcode, std::uint64_t at, std::uint64_t size);
  Status take_small(Opcode opcode, std::uint64_t at, std::uint64_t size);
  Status take_chunk(std::uint64_t at, std::uint64_t size);
  Status take_message(std::uint64_t at, std::uint64_t size);
  void take_statistics(View content);
  void define(Opcode opcode, View content);
  Status count_all();
  void count(Block& block, View records);

  Part& part_;
  bool complete_ = false;    // it has a footer and the final magic
  bool statistics_ = false;  // it has a count of messages
  bool outside_ = false;     // the previous record was a message outside chunks
};

// Walks from record to record without unpacking chunks: the summary of a whole file repeats all
// definitions.
Status Scanner::scan() {
  std::uint64_t at = kMagic.size();
  while (!complete_) {
    if (at == part_.file.size()) break;
    const auto head = part_.file.read(at, kRecordHead);
    if (!head) return head.error();
    In in(*head);
    const auto opcode = Opcode(in.number<std::uint8_t>());
    const auto size = in.number<std::uint64_t>();
    if (!in.good() || size > part_.file.size() - at - kRecordHead) break;
    if (opcode == Opcode{0}) break;  // not a record: zeros of a file system after a loss of power
    if (auto status = take_record(opcode, at + kRecordHead, size); !status) return status;
    at += kRecordHead + size;
  }
  if (complete_ && at + kMagic.size() > part_.file.size()) complete_ = false;
  if (!complete_) {
    part_.complain(
        fmt::format("the recording is cut off after byte {} of {}: everything before that is read",
                    at, part_.file.size()));
  }
  const bool defined = std::ranges::all_of(
      part_.counts, [&](const auto& entry) { return part_.channels.contains(entry.first); });
  return complete_ && statistics_ && defined ? success() : count_all();
}

Status Scanner::take_record(Opcode opcode, std::uint64_t at, std::uint64_t size) {
  if (opcode != Opcode::message) outside_ = false;
  switch (opcode) {
    case Opcode::chunk:
      return take_chunk(at, size);
    case Opcode::message:
      return take_message(at, size);
    case Opcode::footer:
      complete_ = true;
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

Status Scanner::take_small(Opcode opcode, std::uint64_t at, std::uint64_t size) {
  if (size > kMostDefinition) {
    part_.complain(fmt::format("the record at byte {} exceeds the maximum length of its type", at));
    return success();
  }
  const auto content = part_.file.read(at, size);
  if (!content) return content.error();
  if (opcode == Opcode::header) {
    part_.profile = In(*content).text();
  } else if (opcode == Opcode::statistics) {
    take_statistics(*content);
  } else {
    define(opcode, *content);
  }
  return success();
}

void Scanner::define(Opcode opcode, View content) {
  if (opcode == Opcode::schema) {
    if (auto schema = recording::schema_of(content))
      return void(part_.schemas[schema->id] = *schema);
  } else if (opcode == Opcode::channel) {
    if (auto channel = channel_of(content)) return void(part_.channels[channel->id] = *channel);
  } else {
    return;
  }
  part_.complain("a schema or a channel is damaged: its messages are skipped");
}

Status Scanner::take_chunk(std::uint64_t at, std::uint64_t size) {
  const auto head = part_.file.read(at, std::min(size, kChunkHead));
  if (!head) return head.error();
  if (const auto block = chunk_of(*head, at, size)) {
    part_.blocks.push_back(*block);
  } else {
    part_.complain(fmt::format("the chunk at byte {} is damaged and skipped", at));
  }
  return success();
}

Status Scanner::take_message(std::uint64_t at, std::uint64_t size) {
  constexpr std::uint64_t kMessageHead = 22;  // [byte] before the data
  const auto head = part_.file.read(at, std::min(size, kMessageHead));
  if (!head) return head.error();
  const auto message = message_of(*head);
  if (!message) {
    part_.complain(fmt::format("the message at byte {} is damaged and skipped", at));
    outside_ = false;
    return success();
  }
  const std::uint64_t time_ns = message->log_time_ns;
  if (!outside_ || part_.blocks.back().size > kMostOutside) {
    part_.blocks.push_back({.offset = at - kRecordHead, .start_ns = time_ns, .end_ns = time_ns});
  }
  auto& block = part_.blocks.back();
  block.size += kRecordHead + size;
  block.uncompressed_size = block.size;
  block.start_ns = std::min(block.start_ns, time_ns);
  block.end_ns = std::max(block.end_ns, time_ns);
  outside_ = true;
  return success();
}

void Scanner::take_statistics(View content) {
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
  part_.total = messages;
  part_.start_ns = first_ns;
  part_.end_ns = last_ns;
  part_.counts = std::move(by_channel);
  statistics_ = true;
}

Status Scanner::count_all() {
  part_.counts.clear();
  part_.total = 0;
  part_.start_ns = ~0ULL;
  part_.end_ns = 0;
  std::vector<Block> whole;
  for (auto& block : part_.blocks) {
    auto records = load(part_.file, block);
    if (!records && records.code() == ErrorCode::io_failed) return records.error();
    if (!records) {
      part_.complain(records.error().message);
      continue;
    }
    count(block, *records);
    whole.push_back(block);
  }
  part_.blocks = std::move(whole);
  if (part_.total == 0) part_.start_ns = 0;
  return success();
}

// Also finds the true first and last times: those in chunks may be wrong.
void Scanner::count(Block& block, View records) {
  block.start_ns = ~0ULL;
  block.end_ns = 0;
  const bool whole = for_each_record(records, [&](Opcode opcode, View content) {
    const auto message = opcode == Opcode::message ? message_of(content) : std::nullopt;
    if (!message) return define(opcode, content);
    ++part_.counts[message->channel_id];
    ++part_.total;
    block.start_ns = std::min(block.start_ns, message->log_time_ns);
    block.end_ns = std::max(block.end_ns, message->log_time_ns);
  });
  if (!whole) {
    part_.complain(fmt::format("the chunk at byte {} is cut off", block.offset));
  }
  part_.start_ns = std::min(part_.start_ns, block.start_ns);
  part_.end_ns = std::max(part_.end_ns, block.end_ns);
}

}  // namespace

void Part::complain(std::string sentence) {
  if (std::ranges::find(complaints, sentence) != complaints.end()) return;
  complaints.push_back(std::move(sentence));
}

Result<Part> Part::open(const std::string& path) {
  auto file = File::open(path);
  if (!file) return file.error();
  Part part{.file = *std::move(file)};
  const auto magic = part.file.read(0, kMagic.size());
  if (!magic) return magic.error();
  if (!std::ranges::equal(*magic, kMagic)) {
    return fail(ErrorCode::invalid_input,
                path + " is not an MCAP recording: its first bytes are wrong");
  }
  if (auto status = Scanner(part).scan(); !status) return status.error();
  return part;
}

}  // namespace goshawk::recording
