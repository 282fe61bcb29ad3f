#include "goshawk/recording/writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "goshawk/core/random.hpp"
#include "memory_sink.hpp"
#include "records.hpp"

namespace goshawk::recording {
namespace {

constexpr std::uint64_t kPlenty = 1ULL << 30;

struct Written {
  std::shared_ptr<Bytes> bytes = std::make_shared<Bytes>();
  std::vector<Message> messages;  // that write() took
  std::vector<Channel> channels;
  Status closed = success();
  WriterCounts counts;
};

Message random_message(Random& random, std::uint16_t channel, std::uint64_t time_ns) {
  Bytes data(std::size_t(random.below(3000)));
  for (auto& byte : data) byte = random.chance(0.7) ? 0 : (unsigned char)(random.below(256));
  return Message({channel, std::uint32_t(random.below(1000)), time_ns, time_ns + 5, data});
}

Written write_random(std::uint64_t seed, int count, std::uint64_t room = kPlenty,
                     bool reserves = true, WriterOptions options = {}) {
  Random random(seed);
  Written w;
  auto writer = Writer::create(std::make_unique<MemorySink>(w.bytes, room, reserves), options);
  if (!writer) {
    w.closed = writer.error();
    return w;
  }
  for (int k = 0; k < 3; ++k) {
    const auto schema = writer->add_schema("a/msg/T" + std::to_string(k), "ros2msg", "int32 x\n");
    Channel channel{.schema_id = schema,
                    .topic = "/t" + std::to_string(k),
                    .message_encoding = "cdr",
                    .metadata = {{"offered_qos_profiles", "- a: 1\n"}}};
    channel.id = writer->add_channel(channel);
    w.channels.push_back(channel);
  }
  std::uint64_t time_ns = 1'700'000'000'000'000'000;
  for (int i = 0; i < count; ++i) {
    time_ns += std::uint64_t(random.below(3));
    w.messages.push_back(random_message(random, std::uint16_t(1 + random.below(3)), time_ns));
    (void)writer->write(w.messages.back().view());
    if (random.chance(0.05)) (void)writer->flush();
  }
  w.closed = writer->close();
  w.counts = writer->counts();
  return w;
}

TEST(Writer, EveryMessageComesBackAsItWas) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    WriterOptions options;
    options.chunk_bytes = seed % 2 == 0 ? 4096 : 1 << 20;
    options.compression_level = int(seed % 3);
    const Written w = write_random(seed, 300, kPlenty, true, options);
    ASSERT_TRUE(w.closed.ok());
    const TemporaryFile file(*w.bytes);
    auto reader = Reader::open(file.path());
    ASSERT_TRUE(reader.ok());
    EXPECT_TRUE(reader->complaints().empty());
    EXPECT_EQ(reader->profile(), "ros2");
    EXPECT_EQ(read_all(*reader), w.messages);
    EXPECT_EQ(reader->message_count(), w.messages.size());
    EXPECT_EQ(reader->start_ns(), w.messages.front().log_time_ns);
    EXPECT_EQ(reader->end_ns(), w.messages.back().log_time_ns);
    ASSERT_EQ(reader->channels().size(), 3U);
    for (const auto& channel : w.channels) {
      EXPECT_EQ(reader->channels().at(channel.id), channel);
      ASSERT_NE(reader->schema_of(channel), nullptr);
      EXPECT_EQ(reader->schema_of(channel)->data, "int32 x\n");
      EXPECT_EQ(reader->message_count(channel.id),
                std::size_t(std::ranges::count(w.messages, channel.id, &Message::channel_id)));
    }
  }
}

TEST(Writer, FileOfNoMessageIsWhole) {
  const Written w = write_random(1, 0);
  const TemporaryFile file(*w.bytes);
  auto reader = Reader::open(file.path());
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader->complaints().empty());
  EXPECT_EQ(reader->message_count(), 0U);
  EXPECT_EQ(reader->channels().size(), 3U);
}

// Each begin of a chunk's times in a file: of records that stand outside of any other.
std::vector<std::uint64_t> chunk_begins(const Bytes& bytes) {
  std::vector<std::uint64_t> begins;
  for (std::size_t at = 8; at + 9 <= bytes.size() - 8;) {
    std::uint64_t length = 0, start_ns = 0;
    std::memcpy(&length, &bytes[at + 1], 8);
    std::memcpy(&start_ns, &bytes[at + 9], 8);
    if (bytes[at] == 0x06) begins.push_back(start_ns);
    at += 9 + length;
  }
  return begins;
}

// A chunk of no messages would say that the recording begins in 1970.
TEST(Writer, NoChunkIsWithoutMessages) {
  const auto bytes = std::make_shared<Bytes>();
  auto writer = Writer::create(std::make_unique<MemorySink>(bytes, kPlenty, true));
  ASSERT_TRUE(writer.ok());
  const auto first = writer->add_channel({.topic = "/a", .message_encoding = "cdr"});
  ASSERT_TRUE(writer->flush().ok());
  const Bytes data = {0, 1, 0, 0, 42, 0, 0, 0};
  ASSERT_TRUE(writer->write({first, 0, 1'000, 1'000, data}).ok());
  ASSERT_TRUE(writer->flush().ok());
  const auto silent = writer->add_channel({.topic = "/b", .message_encoding = "cdr"});
  ASSERT_TRUE(writer->flush().ok());
  ASSERT_TRUE(writer->flush().ok());
  const auto last = writer->add_channel({.topic = "/c", .message_encoding = "cdr"});
  ASSERT_TRUE(writer->write({last, 0, 2'000, 2'000, data}).ok());
  ASSERT_TRUE(writer->close().ok());
  EXPECT_EQ(chunk_begins(*bytes), (std::vector<std::uint64_t>{1'000, 2'000}));

  const TemporaryFile file(*bytes);
  auto reader = Reader::open(file.path());
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader->complaints().empty());
  EXPECT_EQ(read_all(*reader).size(), 2U);
  EXPECT_EQ(reader->start_ns(), 1'000U);
  EXPECT_EQ(reader->channels().size(), 3U);
  EXPECT_EQ(reader->message_count(silent), 0U);
}

// As after kill -9: the file as it is, without close().
TEST(Writer, WhatWasFlushedIsReadableWithoutAnEnd) {
  const auto bytes = std::make_shared<Bytes>();
  auto writer = Writer::create(std::make_unique<MemorySink>(bytes, kPlenty, true));
  ASSERT_TRUE(writer.ok());
  const auto id = writer->add_channel({.topic = "/a", .message_encoding = "cdr"});
  const Bytes data = {0, 1, 0, 0, 42, 0, 0, 0};
  for (std::uint64_t k = 0; k < 100; ++k) {
    ASSERT_TRUE(writer->write({id, std::uint32_t(k), k, k, data}).ok());
    if (k != 69) continue;
    ASSERT_TRUE(writer->flush().ok());
  }
  const TemporaryFile file(*bytes);
  auto reader = Reader::open(file.path());
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(read_all(*reader).size(), 70U);
  EXPECT_EQ(reader->complaints().size(), 1U);
}

// With any room: every message that counts as written is there, in a file that is whole, if
// room can be reserved; and at least readable if it cannot.
TEST(Writer, FullDiskKeepsWhatWasWritten) {
  const std::size_t all = write_random(7, 100).bytes->size();
  for (std::uint64_t room = 0; room < all + 1000; room += 711) {
    for (const bool reserves : {true, false}) {
      const Written w = write_random(7, 100, room, reserves);
      if (w.bytes->size() < 100) {
        EXPECT_FALSE(w.closed.ok());
        continue;
      }
      const TemporaryFile file(*w.bytes);
      auto reader = Reader::open(file.path());
      ASSERT_TRUE(reader.ok()) << reader.error().message;
      const auto messages = read_all(*reader);
      ASSERT_EQ(messages.size(), w.counts.messages);
      EXPECT_EQ(w.counts.messages + w.counts.lost, w.messages.size());
      EXPECT_TRUE(std::equal(messages.begin(), messages.end(), w.messages.begin()));
      EXPECT_EQ(w.closed.ok(), w.counts.lost == 0 && reader->complaints().empty());
      if (reserves) {
        EXPECT_TRUE(reader->complaints().empty()) << "room " << room;
      }
    }
  }
}

TEST(Writer, SaysWhereAFileCannotBeMade) {
  const auto nowhere = create_file("/nonexistent/folder/a.mcap");
  ASSERT_FALSE(nowhere.ok());
  EXPECT_EQ(nowhere.code(), ErrorCode::io_failed);
  EXPECT_NE(nowhere.error().message.find("/nonexistent/folder/a.mcap"), std::string::npos);
  const TemporaryFile file(Bytes{1, 2, 3});
  EXPECT_FALSE(create_file(file.path()).ok());
  EXPECT_EQ(file.read().size(), 3U);
  EXPECT_TRUE(create_file(file.path(), true).ok());
}

TEST(Writer, RealFileHoldsTheBytesAndNoMore) {
  const TemporaryFile file;
  auto sink = create_file(file.path());
  ASSERT_TRUE(sink.ok());
  auto writer = Writer::create(*std::move(sink));
  ASSERT_TRUE(writer.ok());
  const auto id = writer->add_channel({.topic = "/a", .message_encoding = "cdr"});
  const Bytes data(5000, 7);
  for (std::uint64_t k = 0; k < 50; ++k) ASSERT_TRUE(writer->write({id, 0, k, k, data}).ok());
  ASSERT_TRUE(writer->close().ok());
  EXPECT_EQ(file.read().size(), writer->counts().bytes);
  auto reader = Reader::open(file.path());
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(read_all(*reader).size(), 50U);
}

TEST(Writer, UnknownChannelIsABug) {
  auto writer =
      Writer::create(std::make_unique<MemorySink>(std::make_shared<Bytes>(), kPlenty, true));
  ASSERT_TRUE(writer.ok());
  EXPECT_THROW((void)writer->write({1, 0, 0, 0, {}}), std::invalid_argument);
  EXPECT_THROW((void)writer->add_channel({.schema_id = 9}), std::invalid_argument);
}

}  // namespace
}  // namespace goshawk::recording
