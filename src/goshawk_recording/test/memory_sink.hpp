#pragma once

#include "goshawk/recording/reader.hpp"
#include "goshawk/recording/writer.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace goshawk::recording {

/// A disk of `room` bytes. What is reserved is as good as written.
class MemorySink : public Sink {
 public:
  MemorySink(std::shared_ptr<Bytes> bytes, std::uint64_t room, bool reserves)
      : bytes_(std::move(bytes)), room_(room), reserves_(reserves) {}

  Status append(View view) override {
    const auto most = std::size_t(room_ - std::min<std::uint64_t>(room_, bytes_->size()));
    const View part = view.first(std::min(view.size(), most));
    bytes_->insert(bytes_->end(), part.begin(), part.end());
    return part.size() == view.size() ? success() : fail(ErrorCode::io_failed, "no room");
  }
  Status reserve(std::uint64_t size) override {
    if (!reserves_ || bytes_->size() + size <= room_) return success();
    return fail(ErrorCode::io_failed, "no room to reserve");
  }
  Status cut(std::uint64_t size) override {
    bytes_->resize(std::size_t(size));
    return success();
  }

 private:
  std::shared_ptr<Bytes> bytes_;
  std::uint64_t room_;
  bool reserves_;
};

/// A file that goes away with the test.
class TemporaryFile {
 public:
  TemporaryFile()
      : path_((std::filesystem::temp_directory_path() /
               ("goshawk-recording-" + std::to_string(getpid()) + "-" + std::to_string(count_++)))
                  .string()) {}
  explicit TemporaryFile(View bytes) : TemporaryFile() { write(bytes); }
  ~TemporaryFile() { std::filesystem::remove(path_); }

  void write(View bytes) const {
    std::ofstream file(path_, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  }
  Bytes read() const {
    std::ifstream file(path_, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(file), {});
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  static inline int count_ = 0;
};

/// A message that owns its bytes.
struct Message {
  std::uint16_t channel_id;
  std::uint32_t sequence;
  std::uint64_t log_time_ns, publish_time_ns;
  Bytes data;
  explicit Message(const MessageView& m)
      : channel_id(m.channel_id),
        sequence(m.sequence),
        log_time_ns(m.log_time_ns),
        publish_time_ns(m.publish_time_ns),
        data(m.data.begin(), m.data.end()) {}
  MessageView view() const { return {channel_id, sequence, log_time_ns, publish_time_ns, data}; }
  bool operator==(const Message&) const = default;
};

inline std::vector<Message> read_all(Reader& reader, const ReadOptions& options = {}) {
  std::vector<Message> messages;
  const auto status = reader.read(options, [&](const MessageView& m) {
    messages.emplace_back(m);
    return true;
  });
  if (!status) throw std::runtime_error(status.error().message);
  return messages;
}

}  // namespace goshawk::recording
