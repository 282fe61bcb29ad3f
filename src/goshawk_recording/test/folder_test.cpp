// Recordings of several files, as rosbag2 leaves them; and the file with chunks of LZ4 that was
// once called damaged.
#include <gmock/gmock.h>

#include <cstdlib>

#include "memory_sink.hpp"

namespace goshawk::recording {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A folder of its own that goes away with the test.
class Folder {
 public:
  Folder() {
    static int number = 0;
    path_ = fs::temp_directory_path() /
            ("goshawk_bag_" + std::to_string(::getpid()) + "_" + std::to_string(number++));
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path() const { return path_.string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }
  /// A file of messages on topics, each at a time and with it as its only byte.
  void record(const std::string& name,
              const std::vector<std::pair<std::string, unsigned char>>& messages) const {
    auto writer = Writer::create(*create_file((path_ / name).string()), {});
    const auto schema = writer->add_schema("std_msgs/msg/Char", "ros2msg", "char data\n");
    std::map<std::string, std::uint16_t> ids;
    for (const auto& [topic, time] : messages) {
      if (!ids.contains(topic)) {
        ids[topic] =
            writer->add_channel({.schema_id = schema, .topic = topic, .message_encoding = "cdr"});
      }
      const Bytes data{time};
      ASSERT_TRUE(writer->write({ids[topic], 0, time, time, data}));
    }
    ASSERT_TRUE(writer->close());
  }

 private:
  fs::path path_;
};

const std::string kMetadata =
    "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: mcap\n"
    "  relative_file_paths:\n    - a_0.mcap\n    - \"a_1.mcap\"\n  duration:\n    nanoseconds: 7\n";

/// "TOPIC TIME" of each message.
std::vector<std::string> told(Reader& reader, const ReadOptions& options = {}) {
  std::vector<std::string> lines;
  for (const auto& m : read_all(reader, options)) {
    EXPECT_EQ(m.data, Bytes{(unsigned char)(m.log_time_ns)});
    lines.push_back(reader.channels().at(m.channel_id).topic + " " + std::to_string(m.log_time_ns));
  }
  return lines;
}

TEST(Bag, ItsFilesAreOneRecordingWhateverTheyCallTheirChannels) {
  const Folder folder;
  folder.record("a_0.mcap", {{"/a", 1}, {"/b", 2}, {"/a", 5}});
  folder.record("a_1.mcap", {{"/c", 4}, {"/b", 6}, {"/a", 7}});  // /c has the number of /a above
  folder.record("other.mcap", {{"/other", 3}});                  // not listed
  folder.write("metadata.yaml", kMetadata);
  auto reader = Reader::open(folder.path());
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_THAT(reader->complaints(), IsEmpty());
  EXPECT_EQ(reader->message_count(), 6U);
  EXPECT_EQ(reader->channels().size(), 3U);
  EXPECT_EQ(reader->schemas().size(), 1U);
  EXPECT_EQ(reader->start_ns(), 1U);
  EXPECT_EQ(reader->end_ns(), 7U);
  EXPECT_THAT(told(*reader), ElementsAre("/a 1", "/b 2", "/c 4", "/a 5", "/b 6", "/a 7"));
  for (const auto& [id, channel] : reader->channels()) {
    EXPECT_EQ(channel.id, id);
    EXPECT_EQ(reader->schema_of(channel)->name, "std_msgs/msg/Char");
    EXPECT_EQ(reader->message_count(id), channel.topic == "/a"   ? 3U
                                         : channel.topic == "/b" ? 2U
                                                                 : 1U);
    if (channel.topic != "/c") continue;
    EXPECT_THAT(told(*reader, {.channels = std::set{id}}), ElementsAre("/c 4"));
  }
}

TEST(Bag, ItsFilesMayBeListedInOneLineAndMetadataOfOthersIsLeftAlone) {
  const Folder folder;
  folder.record("a_0.mcap", {{"/a", 1}});
  folder.record("a_1.mcap", {{"/a", 2}});
  folder.write("metadata.yaml",
               "rosbag2_bagfile_information: {relative_file_paths: [a_0.mcap, 'a_1.mcap']}\n");
  auto reader = Reader::open(folder.path());
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_THAT(told(*reader), ElementsAre("/a 1", "/a 2"));
  const Folder other;
  other.record("flight.mcap", {{"/a", 4}});
  other.write("metadata.yaml", "author: somebody\n");
  EXPECT_TRUE(Reader::open(other.path()));
}

TEST(Bag, AFileThatIsMissingIsNamedAndTheOthersAreRead) {
  const Folder folder;
  folder.record("a_1.mcap", {{"/a", 4}});
  folder.write("metadata.yaml", kMetadata);
  auto reader = Reader::open(folder.path());
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_THAT(reader->complaints(), ElementsAre(HasSubstr("a_0.mcap, which is missing")));
  EXPECT_THAT(told(*reader), ElementsAre("/a 4"));
}

TEST(Bag, AFolderWithOneRecordingIsThatRecording) {
  const Folder folder;
  folder.record("flight.mcap", {{"/a", 4}});
  folder.write("flight.json", "{}");
  auto reader = Reader::open(folder.path());
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_THAT(told(*reader), ElementsAre("/a 4"));
}

TEST(Bag, WhatIsNoRecordingIsRefusedForTheTrueReason) {
  const auto why = [](const Folder& folder) {
    const auto reader = Reader::open(folder.path());
    return reader ? std::string("read") : reader.error().message;
  };
  const Folder empty, sqlite, two, packed, gone;
  EXPECT_THAT(why(empty), HasSubstr("without a recording"));
  sqlite.write("bag_0.db3", "SQLite format 3");
  EXPECT_THAT(why(sqlite), AllOf(HasSubstr("SQLite"), HasSubstr("ros2 bag convert")));
  sqlite.write("metadata.yaml",
               "rosbag2_bagfile_information:\n  relative_file_paths:\n    - bag_0.db3\n");
  EXPECT_THAT(why(sqlite), HasSubstr("SQLite"));
  two.record("a.mcap", {{"/a", 1}});
  two.record("b.mcap", {{"/a", 2}});
  EXPECT_THAT(why(two), AllOf(HasSubstr("2 recordings"), HasSubstr("a.mcap")));
  packed.write("metadata.yaml",
               "rosbag2_bagfile_information:\n  relative_file_paths:\n    - a_0.mcap.zstd\n");
  EXPECT_THAT(why(packed), HasSubstr("a_0.mcap.zstd"));
  gone.write("metadata.yaml", kMetadata);
  EXPECT_THAT(why(gone), HasSubstr("none of the files"));
  for (const auto* damaged : {"rosbag2_bagfile_information: [", "a: b: c",
                              "rosbag2_bagfile_information:\n  duration: 7\n"}) {
    gone.write("metadata.yaml", damaged);
    EXPECT_THAT(why(gone), HasSubstr("metadata.yaml does not list the bag's files")) << damaged;
  }
}

TEST(SharedCase, TheRecordingWithChunksOfLz4IsRead) {
  const char* cases = std::getenv("GOSHAWK_CASES");
  const char* data = std::getenv("GOSHAWK_DATA");
  for (const std::string& root : {std::string(cases != nullptr ? cases : ""),
                                  data != nullptr ? std::string(data) + "/../cases" : "",
                                  std::string(GOSHAWK_SOURCE_ROOT) + "/../shared/cases"}) {
    const std::string file = root + "/mcap_lz4/m_chunk_lz4ok.mcap";
    if (root.empty() || !fs::exists(file)) continue;
    auto reader = Reader::open(file);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_THAT(reader->complaints(), IsEmpty());
    EXPECT_GT(reader->message_count(), 0U);
    EXPECT_EQ(read_all(*reader).size(), reader->message_count());
    return;
  }
  GTEST_SKIP() << "the case m_chunk_lz4ok.mcap is not here: set GOSHAWK_CASES to its folder";
}

}  // namespace
}  // namespace goshawk::recording
