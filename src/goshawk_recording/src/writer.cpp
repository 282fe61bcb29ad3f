#include "goshawk/recording/writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <stdexcept>

#include "records.hpp"

namespace goshawk::recording {
namespace {

constexpr std::uint64_t kFooterRoom = 4096;  // [byte] for DataEnd, Statistics, offsets, Footer
constexpr std::size_t kMostIds = 65535;

struct IndexEntry {
  std::uint64_t time_ns;
  std::uint64_t offset;  // [byte] in the chunk, uncompressed
};

struct ChunkIndex {
  std::uint64_t start_ns, end_ns, offset, length;
  std::map<std::uint16_t, std::uint64_t> index_offsets;
  std::uint64_t indices_length, compressed_size, uncompressed_size;
  std::string compression;
};

/// The chunk that is being filled.
struct OpenChunk {
  Bytes records;
  std::map<std::uint16_t, std::vector<IndexEntry>> index;
  std::uint64_t start_ns = ~0ULL, end_ns = 0, messages = 0;

  void clear() {
    records.clear();
    for (auto& [channel, entries] : index) entries.clear();
    start_ns = ~0ULL;
    end_ns = messages = 0;
  }
};

void put(Out& out, const ChunkIndex& c) {
  out.record(Opcode::chunk_index, [&](Out& o) {
    o.number(c.start_ns).number(c.end_ns).number(c.offset).number(c.length);
    o.sized<std::uint32_t>([&](Out& map) {
      for (const auto& [channel, offset] : c.index_offsets) map.number(channel).number(offset);
    });
    o.number(c.indices_length).text(c.compression);
    o.number(c.compressed_size).number(c.uncompressed_size);
  });
}

}  // namespace

struct Writer::Impl {
  std::unique_ptr<Sink> sink;
  WriterOptions options;
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> compressor{ZSTD_createCCtx(),
                                                                  &ZSTD_freeCCtx};
  std::vector<Schema> schemas;    // id is the index + 1
  std::vector<Channel> channels;  // id is the index + 1
  std::map<std::uint16_t, std::uint64_t> channel_counts;
  std::vector<ChunkIndex> chunks;
  OpenChunk chunk;
  Bytes compressed, pending;  // reused for each chunk
  std::uint64_t size = 0;     // [byte] of whole records in the sink
  std::uint32_t crc = 0;      // of these bytes
  std::uint64_t summary_room = kFooterRoom;
  std::uint64_t start_ns = ~0ULL, end_ns = 0;
  WriterCounts counts;
  Status state = success();
  bool closed = false;

  Status append(View bytes);
  Status close_chunk();
  Status append_bare();
  View compress();
  void put_indices(Out& out, ChunkIndex& entry, std::uint64_t at) const;
  void count_chunk(ChunkIndex entry);
  Bytes summary(std::uint64_t at) const;
  void put_statistics(Out& out) const;
};

Status Writer::Impl::append(View bytes) {
  if (auto status = sink->append(bytes); !status) return status;
  crc = crc32_of(bytes, crc);
  size += bytes.size();
  return success();
}

View Writer::Impl::compress() {
  if (options.compression_level == 0) return chunk.records;
  compressed.resize(ZSTD_compressBound(chunk.records.size()));
  const std::size_t length =
      ZSTD_compressCCtx(compressor.get(), compressed.data(), compressed.size(),
                        chunk.records.data(), chunk.records.size(), options.compression_level);
  if (ZSTD_isError(length)) throw std::runtime_error(ZSTD_getErrorName(length));
  return View(compressed).first(length);
}

void Writer::Impl::put_indices(Out& out, ChunkIndex& entry, std::uint64_t at) const {
  const std::size_t before = pending.size();
  for (const auto& [channel, entries] : chunk.index) {
    if (entries.empty()) continue;
    entry.index_offsets[channel] = at + pending.size() - before;
    out.record(Opcode::message_index, [&, id = channel](Out& o) {
      o.number(id).sized<std::uint32_t>([&](Out& list) {
        for (const auto& e : entries) list.number(e.time_ns).number(e.offset);
      });
    });
  }
  entry.indices_length = pending.size() - before;
}

// Schemas and channels that come before any message are written outside chunks: a chunk without
// messages would begin in 1970, which readers take for the start of the recording (@mcap/core 1.2),
// or they refuse a chunk without indices.
Status Writer::Impl::append_bare() {
  state = sink->reserve(chunk.records.size() + summary_room);
  if (state) state = append(chunk.records);
  if (state) chunk.clear();
  return state;
}

Status Writer::Impl::close_chunk() {
  if (!state || chunk.records.empty()) return state;
  if (chunk.messages == 0) return append_bare();
  const View records = compress();
  ChunkIndex entry{.start_ns = chunk.start_ns,
                   .end_ns = chunk.end_ns,
                   .offset = size,
                   .length = 0,
                   .index_offsets = {},
                   .indices_length = 0,
                   .compressed_size = records.size(),
                   .uncompressed_size = chunk.records.size(),
                   .compression = options.compression_level == 0 ? "" : "zstd"};
  pending.clear();
  Out out(pending);
  out.record(Opcode::chunk, [&](Out& o) {
    o.number(entry.start_ns).number(entry.end_ns).number(entry.uncompressed_size);
    o.number(crc32_of(chunk.records)).text(entry.compression);
    o.number(entry.compressed_size).raw(records);
  });
  entry.length = pending.size();
  put_indices(out, entry, size + entry.length);
  const std::uint64_t room = 128 + 10 * entry.index_offsets.size();
  state = sink->reserve(pending.size() + summary_room + room);
  if (state) state = append(pending);
  if (!state) {
    counts.lost += chunk.messages;
    return state;
  }
  summary_room += room;
  count_chunk(std::move(entry));
  chunk.clear();
  return success();
}

void Writer::Impl::count_chunk(ChunkIndex entry) {
  for (const auto& [channel, entries] : chunk.index) channel_counts[channel] += entries.size();
  counts.messages += chunk.messages;
  start_ns = std::min(start_ns, chunk.start_ns);
  end_ns = std::max(end_ns, chunk.end_ns);
  chunks.push_back(std::move(entry));
}

void Writer::Impl::put_statistics(Out& out) const {
  out.record(Opcode::statistics, [&](Out& o) {
    o.number(counts.messages).number(std::uint16_t(schemas.size()));
    o.number(std::uint32_t(channels.size())).number(std::uint32_t{0}).number(std::uint32_t{0});
    o.number(std::uint32_t(chunks.size())).number(counts.messages > 0 ? start_ns : 0);
    o.number(end_ns).sized<std::uint32_t>([&](Out& map) {
      for (const auto& [channel, count] : channel_counts) map.number(channel).number(count);
    });
  });
}

/// DataEnd, the groups of the summary with their offsets, and the footer.
/// @param at offset in the file
Bytes Writer::Impl::summary(std::uint64_t at) const {
  Bytes bytes;
  Out out(bytes);
  out.record(Opcode::data_end, [&](Out& o) { o.number(crc); });
  const std::size_t begin = bytes.size();
  struct Group {
    Opcode opcode;
    std::uint64_t start, length;
  };
  std::vector<Group> groups;
  const auto group = [&](Opcode opcode, const auto& fill) {
    const std::size_t from = bytes.size();
    fill();
    if (bytes.size() > from) groups.push_back({opcode, at + from, bytes.size() - from});
  };
  using recording::put;
  group(Opcode::schema, [&] { std::ranges::for_each(schemas, [&](auto& s) { put(out, s); }); });
  group(Opcode::channel, [&] { std::ranges::for_each(channels, [&](auto& c) { put(out, c); }); });
  group(Opcode::statistics, [&] { put_statistics(out); });
  group(Opcode::chunk_index, [&] { std::ranges::for_each(chunks, [&](auto& c) { put(out, c); }); });
  const std::size_t offsets = bytes.size();
  for (const auto& g : groups) {
    out.record(Opcode::summary_offset,
               [&](Out& o) { o.number(std::uint8_t(g.opcode)).number(g.start).number(g.length); });
  }
  out.number(std::uint8_t(Opcode::footer)).number(std::uint64_t{20});
  out.number(std::uint64_t(at + begin)).number(std::uint64_t(at + offsets));
  out.number(crc32_of(View(bytes).subspan(begin)));
  out.raw(kMagic);
  return bytes;
}

Writer::Writer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Writer::Writer(Writer&&) noexcept = default;
Writer& Writer::operator=(Writer&&) noexcept = default;
Writer::~Writer() {
  if (impl_ != nullptr && !impl_->closed) (void)close();
}

Result<Writer> Writer::create(std::unique_ptr<Sink> sink, const WriterOptions& options) {
  auto impl = std::make_unique<Impl>();
  impl->sink = std::move(sink);
  impl->options = options;
  Bytes head(kMagic.begin(), kMagic.end());
  Out(head).record(Opcode::header, [&](Out& o) { o.text(options.profile).text(options.library); });
  auto status = impl->sink->reserve(head.size() + kFooterRoom);
  if (status) status = impl->append(head);
  impl->closed = !status;  // then there is nothing to close
  if (!status) return status.error();
  return Writer(std::move(impl));
}

std::uint16_t Writer::add_schema(std::string name, std::string encoding, std::string data) {
  auto& w = *impl_;
  if (w.schemas.size() == kMostIds) throw std::length_error("Writer: too many schemas");
  const auto id = std::uint16_t(w.schemas.size() + 1);
  w.schemas.push_back({id, std::move(name), std::move(encoding), std::move(data)});
  const std::size_t before = w.chunk.records.size();
  Out out(w.chunk.records);
  put(out, w.schemas.back());
  w.summary_room += w.chunk.records.size() - before;
  return id;
}

std::uint16_t Writer::add_channel(Channel channel) {
  auto& w = *impl_;
  if (w.channels.size() == kMostIds) throw std::length_error("Writer: too many channels");
  if (channel.schema_id > w.schemas.size()) throw std::invalid_argument("Writer: unknown schema");
  channel.id = std::uint16_t(w.channels.size() + 1);
  w.channels.push_back(std::move(channel));
  const std::size_t before = w.chunk.records.size();
  Out out(w.chunk.records);
  put(out, w.channels.back());
  w.summary_room += w.chunk.records.size() - before + 10;
  return w.channels.back().id;
}

Status Writer::write(const MessageView& message) {
  auto& w = *impl_;
  if (message.channel_id == 0 || message.channel_id > w.channels.size()) {
    throw std::invalid_argument("Writer: unknown channel");
  }
  if (w.closed) throw std::logic_error("Writer: closed");
  if (!w.state) {
    ++w.counts.lost;
    return w.state;
  }
  auto& chunk = w.chunk;
  chunk.index[message.channel_id].push_back({message.log_time_ns, chunk.records.size()});
  Out out(chunk.records);
  put(out, message);
  ++chunk.messages;
  chunk.start_ns = std::min(chunk.start_ns, message.log_time_ns);
  chunk.end_ns = std::max(chunk.end_ns, message.log_time_ns);
  return chunk.records.size() >= w.options.chunk_bytes ? w.close_chunk() : success();
}

Status Writer::flush() {
  return impl_->close_chunk();
}

Status Writer::close() {
  auto& w = *impl_;
  if (w.closed) return w.state;
  (void)w.close_chunk();
  w.closed = true;
  // Removes half a chunk: the summary follows, and may need the disk's last bytes.
  if (auto cut = w.sink->cut(w.size); !cut) return w.state ? cut : w.state;
  const Bytes end = w.summary(w.size);
  if (auto status = w.sink->append(end); !status) {
    (void)w.sink->cut(w.size);
    if (w.state) w.state = status;
  } else {
    w.size += end.size();
  }
  return w.state;
}

WriterCounts Writer::counts() const {
  WriterCounts counts = impl_->counts;
  counts.bytes = impl_->size;
  return counts;
}

}  // namespace goshawk::recording
