#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "goshawk/recording/sink.hpp"

namespace goshawk::recording {
namespace {

class FileSink : public Sink {
 public:
  FileSink(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  ~FileSink() override {
    // Gives back blocks that were reserved but not used; if that fails, nothing can be done.
    if (reserved_ > size_ && ftruncate(descriptor_, off_t(size_)) != 0) reserved_ = size_;
    close(descriptor_);
  }

  Status append(View bytes) override {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return fault("cannot be written");
      size_ += std::uint64_t(written);
      bytes = bytes.subspan(std::size_t(written));
    }
    return success();
  }

  Status reserve(std::uint64_t size) override {
    if (size_ + size <= reserved_) return success();
    // Reserves blocks of the disk; the length of the file stays.
    if (fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, off_t(size_), off_t(size)) == 0) {
      reserved_ = size_ + size;
    } else if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG) {
      return fault("cannot grow");
    }
    return success();
  }

  Status cut(std::uint64_t size) override {
    if (size == size_) return success();
    if (ftruncate(descriptor_, off_t(size)) != 0 ||
        lseek(descriptor_, off_t(size), SEEK_SET) != off_t(size)) {
      return fault("cannot be truncated");
    }
    size_ = reserved_ = size;
    return success();
  }

 private:
  Error fault(const std::string& what) const {
    return fail(ErrorCode::io_failed, path_ + " " + what + ": " + std::strerror(errno));
  }

  std::string path_;
  int descriptor_;
  std::uint64_t size_ = 0;
  std::uint64_t reserved_ = 0;
};

}  // namespace

Result<std::unique_ptr<Sink>> create_file(const std::string& path, bool overwrite) {
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (overwrite ? O_TRUNC : O_EXCL);
  const int descriptor = open(path.c_str(), flags, 0666);
  if (descriptor >= 0) return std::unique_ptr<Sink>(new FileSink(path, descriptor));
  if (errno == EEXIST) {
    return fail(ErrorCode::io_failed,
                path + " already exists: choose another name, or overwrite it");
  }
  return fail(ErrorCode::io_failed, path + " cannot be created: " + std::strerror(errno));
}

}  // namespace goshawk::recording
