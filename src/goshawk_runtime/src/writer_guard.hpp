#pragma once

#include <deque>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "context_impl.hpp"
#include "goshawk/runtime/writers.hpp"
#include "one_writer.hpp"

namespace goshawk::runtime {

Participant participant_of(const rtps::GuidPrefix_t& prefix);

/// The topics of one group, and who is heard on them. Safe to call from several threads.
class WriterGuard {
 public:
  using OnRefused = std::function<void(const Error&)>;

  /// @param on_refused told of each process that is not heard, at its 1st, 2nd, 4th ... message
  WriterGuard(Context::Impl& context, const OnRefused& on_refused);

  void found(const Participant& writer);
  void lost(const Participant& writer);

  /// @param part 0: one process for the group; else one for each value
  /// @param topic as people know it, for the sentence
  bool admits(const Participant& writer, std::uint8_t part, const std::string& topic);

  bool is_matched(const Participant& writer);

  /// As admits(), of the whole group, for a message that was refused before: it is not counted.
  bool admits_now(const Participant& writer);

 private:
  bool is_alive(const Participant& writer);
  bool lives(const Participant& writer) const;
  OneWriter& chooser(std::uint8_t part);
  /// @return what to say, or nothing
  std::optional<Error> count_refusal(const Participant& writer, const Participant& chosen,
                                     const std::string& topic);

  Context::Impl& context_;
  const OnRefused& on_refused_;
  Participant own_;
  OneWriter::Rank rank_;
  std::mutex mutex_;
  OneWriter writers_;  // also knows who is matched
  std::map<std::uint8_t, OneWriter> parts_;

  Participant lived_{};  // was found alive
  std::int64_t lived_ns_ = 0;

  std::deque<Participant> named_;  // whom sentences were about, the newest ones
  std::uint64_t refusals_ = 0;
  std::int64_t said_ns_ = 0;
};

/// Tells a guard whom a reader has matched.
class MatchListener : public dds::DataReaderListener {
 public:
  explicit MatchListener(std::shared_ptr<WriterGuard> guard) : guard_(std::move(guard)) {}
  void on_subscription_matched(dds::DataReader* reader,
                               const dds::SubscriptionMatchedStatus& status) override;

 private:
  std::shared_ptr<WriterGuard> guard_;
};

}  // namespace goshawk::runtime
