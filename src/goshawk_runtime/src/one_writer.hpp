#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "goshawk/runtime/writers.hpp"

namespace goshawk::runtime {

/// Chooses the one process that is heard on a group of topics, and keeps it while it lives.
///
/// The first that was found is chosen, even if it has said nothing so far, so that a stranger
/// cannot take the place of a stage that seldom speaks. When the chosen one has died, another may
/// follow at once, except one that was refused before: it must wait for kGrace_ns, because the
/// place belongs to the stage that is started again.
class OneWriter {
 public:
  using IsAlive = std::function<bool(const Participant&)>;
  /// How much a process looks like a stage. One of a higher rank replaces one of a lower.
  using Rank = std::function<int(const Participant&)>;

  static constexpr std::int64_t kGrace_ns = 2'000'000'000;

  /// @param own the process that this one is: chosen before all others if it writes itself
  explicit OneWriter(const Participant& own, Rank rank = {}) : own_(own), rank_(std::move(rank)) {}

  /// A writer of the process was matched, or no longer is.
  void found(const Participant& writer);
  void lost(const Participant& writer);
  bool is_matched(const Participant& writer) const;

  /// @param now_ns [ns] of a monotonic clock
  /// @param is_alive asked about the chosen process if another one speaks
  /// @return whether a message of this process is heard
  bool admits(const Participant& writer, std::int64_t now_ns, const IsAlive& is_alive);

  const std::optional<Participant>& chosen() const { return chosen_; }

 private:
  void choose(const Participant& speaker, const IsAlive& is_alive);
  bool was_refused(const Participant& writer) const;
  int rank(const Participant& writer) const { return rank_ ? rank_(writer) : 0; }

  Participant own_;
  Rank rank_;
  std::vector<std::pair<Participant, int>> matched_;  // writers of each, in order of discovery
  std::optional<Participant> chosen_;
  std::deque<Participant> refused_;  // beside the chosen one, the newest
  std::int64_t died_ns_ = 0;         // when the chosen one was found dead; 0: it was not
};

}  // namespace goshawk::runtime
