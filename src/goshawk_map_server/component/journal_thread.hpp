#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "goshawk/map_server/map_journal.hpp"

namespace goshawk::map_server {

/// Writes a journal in a thread of its own, so that no disk ever holds up the map. What waits is
/// bounded by the map: a newer brick replaces the one that was not written yet.
class JournalThread {
 public:
  explicit JournalThread(MapJournal journal);
  /// Writes what still waits.
  ~JournalThread();
  JournalThread(const JournalThread&) = delete;
  JournalThread& operator=(const JournalThread&) = delete;

  void add(std::uint64_t version, std::vector<JournalBrick> bricks);

  /// The newest fault of writing, once; it is tried again every second.
  std::optional<Error> take_fault();

 private:
  void run();

  MapJournal journal_;  // of the thread
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<Index3, JournalBrick, JournalOrder> waiting_;
  std::uint64_t version_ = 0;
  std::optional<Error> fault_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace goshawk::map_server
