#include "journal_thread.hpp"

#include <chrono>
#include <utility>

namespace goshawk::map_server {

JournalThread::JournalThread(MapJournal journal)
    : journal_(std::move(journal)), thread_([this] { run(); }) {}

JournalThread::~JournalThread() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void JournalThread::add(std::uint64_t version, std::vector<JournalBrick> bricks) {
  if (bricks.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    version_ = version;
    for (JournalBrick& brick : bricks) waiting_.insert_or_assign(brick.corner, brick);
  }
  changed_.notify_one();
}

std::optional<Error> JournalThread::take_fault() {
  const std::lock_guard lock(mutex_);
  return std::exchange(fault_, {});
}

void JournalThread::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return ending_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    std::vector<JournalBrick> batch;
    for (const auto& [corner, brick] : waiting_) batch.push_back(brick);
    waiting_.clear();
    const std::uint64_t version = version_;
    lock.unlock();
    const Status status = journal_.append(version, batch);
    lock.lock();
    if (status) continue;
    fault_ = status.error();
    // What came meanwhile is newer than what was not written.
    for (JournalBrick& brick : batch) waiting_.try_emplace(brick.corner, brick);
    if (ending_) return;
    changed_.wait_for(lock, std::chrono::seconds(1), [&] { return ending_; });
  }
}

}  // namespace goshawk::map_server
