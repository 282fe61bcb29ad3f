#include "goshawk/map_server/map_journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "journal_format.hpp"

namespace goshawk::map_server {
namespace {

constexpr auto kSmall = MapJournal::kSmall_bytes;
constexpr std::size_t kObsolete = 4;      // times as long as what counts in it

Error not_written(const std::string& path, int why) {
  return fail(ErrorCode::io_failed,
              fmt::format("the journal of the map '{}' cannot be written: {}. What is learnt from "
                          "now on is lost if the map server dies: make room, or set journal_file "
                          "to another folder",
                          path, std::system_category().message(why)));
}

// @return 0 or an errno
int write_all(int file, std::span<const std::byte> bytes, std::size_t at) {
  while (!bytes.empty()) {
    const ssize_t n = pwrite(file, bytes.data(), bytes.size(), off_t(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return n < 0 ? errno : ENOSPC;
    bytes = bytes.subspan(std::size_t(n));
    at += std::size_t(n);
  }
  return 0;
}

Result<std::vector<std::byte>> read_all(int file, const std::string& path) {
  struct stat status {};
  if (fstat(file, &status) != 0) return not_written(path, errno);
  std::vector<std::byte> bytes(std::size_t(status.st_size));
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t n = pread(file, bytes.data() + at, bytes.size() - at, off_t(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return not_written(path, n < 0 ? errno : EIO);
    at += std::size_t(n);
  }
  return bytes;
}

}  // namespace

MapJournal::MapJournal(std::string path, const JournalIdentity& identity, int file)
    : path_(std::move(path)), identity_(identity), file_(file) {}

MapJournal::MapJournal(MapJournal&& other) noexcept
    : path_(std::move(other.path_)),
      identity_(other.identity_),
      file_(std::exchange(other.file_, -1)),
      content_(std::move(other.content_)),
      places_(std::move(other.places_)),
      end_(other.end_),
      next_compaction_(other.next_compaction_) {}

MapJournal::~MapJournal() {
  if (file_ >= 0) close(file_);
}

Result<MapJournal> MapJournal::create(const std::string& path, const JournalIdentity& identity) {
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return not_written(path, errno);
  MapJournal journal(path, identity, file);
  const JournalHead head = head_of(identity);
  const int fault = write_all(file, std::as_bytes(std::span(&head, 1)), 0);
  if (fault != 0) return not_written(path, fault);
  journal.end_ = sizeof head;
  return journal;
}

Result<MapJournal> MapJournal::open(const std::string& path, const JournalIdentity& identity) {
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0 && errno == ENOENT) return create(path, identity);
  if (file < 0) return not_written(path, errno);
  MapJournal journal(path, identity, file);
  const auto bytes = read_all(file, path);
  if (!bytes) return bytes.error();
  if (bytes->empty()) return create(path, identity);  // it died before it had written the head
  auto content = read_journal(*bytes, identity);
  if (!content) return content.error();
  journal.content_ = *std::move(content);
  // Written anew, it has no damaged entries, and one of each brick. Without room for that it is read
  // all the same, and goes on after what is whole.
  if (!journal.compact()) journal.end_ = journal.content_.whole_bytes;
  return journal;
}

void MapJournal::forget_content() {
  content_ = {};
}

Status MapJournal::append(std::uint64_t version, std::span<const JournalBrick> bricks) {
  std::vector<JournalEntry> entries;
  entries.reserve(bricks.size());
  for (const JournalBrick& brick : bricks) {
    entries.push_back(entry_of(version, brick, entries.size(), bricks.size()));
  }
  const int fault = write_all(file_, std::as_bytes(std::span(entries)), end_);
  if (fault != 0) {
    // What got there is cut off at the next success, which begins at the same place.
    if (ftruncate(file_, off_t(end_)) != 0) return not_written(path_, errno);
    return not_written(path_, fault);
  }
  for (std::size_t k = 0; k < bricks.size(); ++k) {
    places_[bricks[k].corner] = end_ + k * sizeof(JournalEntry);
  }
  end_ += entries.size() * sizeof(JournalEntry);
  if (end_ < next_compaction_ || end_ < kObsolete * places_.size() * sizeof(JournalEntry)) {
    return success();
  }
  // The batch is written: a journal that stays long is no failure.
  if (!compact_file()) next_compaction_ = end_ + kSmall;
  return success();
}

Status MapJournal::compact_file() {
  const auto bytes = read_all(file_, path_);
  if (!bytes) return bytes.error();
  auto content = read_journal(*bytes, identity_);
  if (!content) return content.error();
  content_ = *std::move(content);
  const Status status = compact();
  forget_content();
  return status;
}

// The content as one batch in a file of its own, which then takes the place of the old one.
Status MapJournal::compact() {
  const std::string beside = path_ + ".part";
  auto anew = create(beside, identity_);
  if (!anew) return anew.error();
  std::vector<JournalBrick> bricks;
  for (const auto& [corner, brick] : content_.bricks) bricks.push_back(brick);
  if (!bricks.empty()) {
    std::size_t at = anew->end_;
    for (std::size_t k = 0; k < bricks.size(); ++k, at += sizeof(JournalEntry)) {
      const JournalEntry entry = entry_of(content_.version, bricks[k], k, bricks.size());
      const int fault = write_all(anew->file_, std::as_bytes(std::span(&entry, 1)), at);
      if (fault != 0) {
        std::remove(beside.c_str());
        return not_written(path_, fault);
      }
      anew->places_[bricks[k].corner] = at;
    }
    anew->end_ = at;
  }
  if (std::rename(beside.c_str(), path_.c_str()) != 0) {
    const int why = errno;
    std::remove(beside.c_str());
    return not_written(path_, why);
  }
  std::swap(file_, anew->file_);
  places_ = std::move(anew->places_);
  end_ = anew->end_;
  next_compaction_ = kSmall;
  return success();
}

}  // namespace goshawk::map_server
