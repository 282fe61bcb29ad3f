#include "goshawk/recording/reader.hpp"

#include <gtest/gtest.h>

#include <zstd.h>
#include <algorithm>

#include "goshawk/core/random.hpp"
#include "memory_sink.hpp"
#include "records.hpp"

namespace goshawk::recording {
namespace {

/// Files as other programs write them.
class Foreign {
 public:
  Foreign() : bytes_(kMagic.begin(), kMagic.end()) {
    out().record(Opcode::header, [](Out& o) { o.text("").text("somebody"); });
  }
  Out out() { return Out(bytes_); }
  static Bytes message(std::uint64_t time_ns, unsigned char value = 0) {
    Bytes bytes;
    Out o(bytes);
    const Bytes data{value};
    put(o, MessageView{1, 0, time_ns, time_ns, data});
    return bytes;
  }
  void define() {
    Out o(bytes_);
    put(o, Channel{.id = 1, .topic = "/a", .message_encoding = "json"});
  }
  void chunk(const Bytes& records, const std::string& compression, std::uint64_t claimed,
             std::uint32_t crc = 0) {
    out().record(Opcode::chunk, [&](Out& o) {
      o.number(std::uint64_t{0}).number(std::uint64_t{100}).number(claimed).number(crc);
      o.text(compression).number(std::uint64_t(records.size())).raw(records);
    });
  }
  void end() {
    out().record(Opcode::data_end, [](Out& o) { o.number(std::uint32_t{0}); });
    out().record(Opcode::footer, [](Out& o) {
      o.number(std::uint64_t{0}).number(std::uint64_t{0}).number(std::uint32_t{0});
    });
    out().raw(kMagic);
  }
  Result<Reader> open() {
    file_.write(bytes_);
    return Reader::open(file_.path());
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
  TemporaryFile file_;
};

Bytes join(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::vector<std::uint64_t> times(Reader& reader, const ReadOptions& options = {}) {
  std::vector<std::uint64_t> list;
  for (const auto& m : read_all(reader, options)) list.push_back(m.log_time_ns);
  return list;
}

Bytes sample_file(int count) {
  const auto bytes = std::make_shared<Bytes>();
  WriterOptions options;
  options.chunk_bytes = 300;
  auto writer = Writer::create(std::make_unique<MemorySink>(bytes, 1 << 30, true), options);
  const auto schema = writer->add_schema("std_msgs/msg/String", "ros2msg", "string data\n");
  const auto id =
      writer->add_channel({.schema_id = schema, .topic = "/a", .message_encoding = "cdr"});
  for (int k = 0; k < count; ++k) {
    const Bytes data(std::size_t(20 + k), (unsigned char)(k));
    (void)writer->write({id, std::uint32_t(k), std::uint64_t(k), std::uint64_t(k), data});
  }
  (void)writer->close();
  return *bytes;
}

using Times = std::vector<std::uint64_t>;

TEST(Reader, ReadsMessagesOutsideOfChunksInOrderOfTime) {
  Foreign file;
  file.define();
  for (const std::uint64_t t : {5, 3, 9}) file.out().raw(Foreign::message(t));
  file.out().record(Opcode(0x80), [](Out& o) { o.text("a private record"); });
  file.out().raw(Foreign::message(4));
  file.end();
  auto reader = file.open();
  ASSERT_TRUE(reader.ok());
  EXPECT_TRUE(reader->complaints().empty());
  EXPECT_EQ(times(*reader), (Times{3, 4, 5, 9}));
  EXPECT_EQ(reader->message_count(1), 4U);
}

TEST(Reader, PutsChunksThatOverlapInOrder) {
  Foreign file;
  file.define();
  const Bytes first = join({Foreign::message(10), Foreign::message(30), Foreign::message(50)});
  const Bytes second = join({Foreign::message(20), Foreign::message(40), Foreign::message(10, 9)});
  file.chunk(first, "", first.size());
  file.chunk(second, "", second.size(), crc32_of(second));
  file.end();
  auto reader = file.open();
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(times(*reader), (Times{10, 10, 20, 30, 40, 50}));
  EXPECT_EQ(read_all(*reader)[1].data[0], 9);  // equal times stay in the file's order
  EXPECT_EQ(times(*reader, {.from_ns = 20, .to_ns = 40}), (Times{20, 30, 40}));
  EXPECT_EQ(times(*reader, {.channels = std::set<std::uint16_t>{7}}), Times{});
  EXPECT_EQ(reader->start_ns(), 10U);
  EXPECT_EQ(reader->end_ns(), 50U);
}

TEST(Reader, LeavesDamagedChunksOutAndSaysSo) {
  const Bytes good = Foreign::message(1);
  for (const auto& [bytes, compression, claimed, crc] :
       {std::tuple{good, "", good.size(), crc32_of(good) + 1},
        std::tuple{good, "zstd", good.size(), 0U}, std::tuple{good, "lz4", good.size(), 0U},
        std::tuple{good, "", good.size() + 1, 0U},
        std::tuple{Bytes{5, 255, 255, 255, 255, 255, 255, 255, 255}, "", std::size_t{9}, 0U}}) {
    Foreign file;
    file.define();
    file.chunk(bytes, compression, claimed, crc);
    file.chunk(good, "", good.size());
    file.end();
    auto reader = file.open();
    ASSERT_TRUE(reader.ok());
    EXPECT_EQ(reader->complaints().size(), 1U);
    EXPECT_EQ(times(*reader), Times{1});
  }
}

TEST(Reader, UnpacksNoMoreThanAChunkClaims) {
  const Bytes zeros(64 << 20, 0);
  Bytes packed(ZSTD_compressBound(zeros.size()));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), zeros.data(), zeros.size(), 1));
  for (const std::uint64_t claimed : {std::uint64_t{100}, ~std::uint64_t{0}}) {
    Foreign file;
    file.define();
    file.chunk(packed, "zstd", claimed);
    file.end();
    auto reader = file.open();
    ASSERT_TRUE(reader.ok());
    EXPECT_EQ(reader->complaints().size(), 1U);
    EXPECT_EQ(times(*reader), Times{});
  }
}

TEST(Reader, NamesWhatIsNoRecording) {
  EXPECT_EQ(Reader::open("/nonexistent.mcap").code(), ErrorCode::io_failed);
  EXPECT_EQ(Reader::open("/").code(), ErrorCode::invalid_input);
  EXPECT_EQ(Reader::open("/dev/null").code(), ErrorCode::io_failed);
  for (const Bytes& bytes : {Bytes{}, Bytes{0x89, 'M', 'C'}, Bytes(1000, 'x')}) {
    const TemporaryFile file(bytes);
    const auto reader = Reader::open(file.path());
    ASSERT_FALSE(reader.ok());
    EXPECT_EQ(reader.code(), ErrorCode::invalid_input);
  }
}

// Cut off at any byte, a file gives a prefix of its messages, and never the whole silently.
TEST(Reader, TruncatedAnywhereGivesAPrefix) {
  const Bytes whole = sample_file(12);
  const TemporaryFile file(whole);
  auto complete = Reader::open(file.path());
  ASSERT_TRUE(complete.ok());
  const auto all = read_all(*complete);
  ASSERT_EQ(all.size(), 12U);
  std::size_t before = 0;
  for (std::size_t size = kMagic.size(); size < whole.size(); ++size) {
    file.write(View(whole).first(size));
    auto reader = Reader::open(file.path());
    ASSERT_TRUE(reader.ok()) << size;
    ASSERT_EQ(reader->complaints().size(), 1U) << size;
    const auto some = read_all(*reader);
    ASSERT_LE(some.size(), all.size());
    ASSERT_TRUE(std::equal(some.begin(), some.end(), all.begin())) << size;
    ASSERT_EQ(reader->message_count(), some.size());
    ASSERT_GE(some.size(), before) << "a longer file gives no less";
    before = some.size();
  }
  EXPECT_EQ(before, 12U);
}

// Where records begin: a flipped opcode makes another record of the same bytes, which no CRC sees.
std::set<std::size_t> opcode_places(const Bytes& file) {
  std::set<std::size_t> places;
  for (std::size_t at = kMagic.size(); at + kRecordHead < file.size();) {
    places.insert(at);
    at += kRecordHead + In(View(file).subspan(at + 1)).number<std::uint64_t>();
  }
  return places;
}

TEST(Reader, FlippedBitsNeitherCrashNorPassAsMessages) {
  const Bytes whole = sample_file(40);
  const auto opcodes = opcode_places(whole);
  ASSERT_GT(opcodes.size(), 10U);
  const TemporaryFile file(whole);
  auto complete = Reader::open(file.path());
  const auto all = read_all(*complete);
  Random random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    Bytes bytes = whole;
    for (int n = 1 + random.below(4); n > 0; --n) {
      const auto at = std::size_t(random.below(int(bytes.size())));
      if (!opcodes.contains(at)) bytes[at] ^= (unsigned char)(1 << random.below(8));
    }
    file.write(bytes);
    auto reader = Reader::open(file.path());
    if (!reader) continue;
    for (const auto& m : read_all(*reader)) {
      EXPECT_NE(std::ranges::find(all, m), all.end()) << "trial " << trial;
    }
  }
}

TEST(Reader, GarbageBehindTheMagicIsNoCrash) {
  Random random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    Bytes bytes(kMagic.begin(), kMagic.end());
    for (int n = random.below(400); n > 0; --n) {
      bytes.push_back((unsigned char)(random.chance(0.5) ? random.below(16) : random.below(256)));
    }
    const TemporaryFile file(bytes);
    auto reader = Reader::open(file.path());
    ASSERT_TRUE(reader.ok());
    (void)read_all(*reader);
  }
}

TEST(Reader, EndsWhereTheCallerHasEnough) {
  const TemporaryFile file(sample_file(40));
  auto reader = Reader::open(file.path());
  int taken = 0;
  ASSERT_TRUE(reader->read({}, [&](const MessageView&) { return ++taken < 5; }).ok());
  EXPECT_EQ(taken, 5);
}

}  // namespace
}  // namespace goshawk::recording
