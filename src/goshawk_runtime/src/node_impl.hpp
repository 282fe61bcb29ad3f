#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <fastdds/dds/core/condition/GuardCondition.hpp>
#include <fastdds/dds/core/condition/WaitSet.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "context_impl.hpp"
#include "goshawk/runtime/node.hpp"
#include "message_type_impl.hpp"
#include "parameter_service.hpp"
#include "writer_guard.hpp"

namespace goshawk::runtime {

using Steady = std::chrono::steady_clock;

// A flood on one topic must not starve timers and the other topics of the node.
inline constexpr int kMostAtOnce = 64;

struct Subscription {
  dds::DataReader* reader = nullptr;
  std::string topic;
  dds::TypeSupport type;
  void* object = nullptr;  // reused for every message
  Node::RawCallback callback;
  std::uint64_t undecoded = 0;

  // Where one process alone is heard.
  std::shared_ptr<WriterGuard> guard;  // nullptr: everybody is heard
  std::unique_ptr<MatchListener> matches;
  std::function<std::uint8_t(const void*)> part;
  bool newest_only = false;  // the reader holds more than the subscriber wants
  bool has_newest = false;
  void* newest = nullptr;  // was heard, waits for a newer one
  MessageInfo newest_info;
  // What a latched writer said while another one was heard: it says it only once.
  std::size_t most_kept = 0;
  Participant kept_of{};
  std::deque<std::pair<void*, MessageInfo>> kept;
};

struct Timer {
  std::int64_t period_ns = 0;
  std::int64_t next_ns = 0;  // of the machine's steady clock, or of simulated time
  std::function<void()> callback;
};

/// A node's part in simulated time (docs/adr/0006-lock-step.md).
struct SimulatedTime {
  bool on = false;
  std::int64_t now_ns = 0;  // 0: none yet

  // Follower in lock step.
  bool takes_turns = false;
  std::unique_ptr<Subscription> turns;
  RawPublisher turns_done;
  std::uint64_t last_turn = 0;

  // Leader of the others.
  bool leads = false;
  std::vector<std::string> followers;  // full names
  std::vector<RawPublisher> turns_of;
  std::unique_ptr<Subscription> answers;
  RawPublisher clock;
  std::int64_t step_ns = 0;
  double speed = 0.0;
  bool begun = false;
  std::uint64_t turn = 0;
  std::pair<std::string, std::uint64_t> answered;  // node and turn
  Steady::time_point next_step;

  bool in_lock_step() const { return takes_turns || leads; }
};

struct Node::Impl {
  explicit Impl(Context::Impl& c) : context(c) {
    wait_set.attach_condition(stop);
    turn_wait_set.attach_condition(stop);
  }

  ~Impl() {
    for (auto& s : subscriptions) {
      wait_set.detach_condition(s->reader->get_statuscondition());
      close(*s);
    }
    for (auto* s : {time.turns.get(), time.answers.get()}) {
      if (s == nullptr) continue;
      turn_wait_set.detach_condition(s->reader->get_statuscondition());
      close(*s);
    }
  }

  Context::Impl& context;
  dds::GuardCondition stop;
  std::atomic<bool> stopping = false;
  dds::WaitSet wait_set;
  dds::WaitSet turn_wait_set;  // only for turns and their answers
  dds::ConditionSeq active;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  std::deque<Timer> timers;  // a callback may add one: elements stay where they are
  bool more = false;         // the last pass left messages behind
  std::vector<std::function<void()>> deferred;                 // for the end of the pass
  std::map<std::string, std::shared_ptr<WriterGuard>> guards;  // by group
  std::function<void(const Error&)> on_second_writer;
  Steady::time_point looked_at_kept;
  bool has_own_ports = false;  // of a reader, instead of the process's one
  SimulatedTime time;
  std::unique_ptr<ParameterService> parameters;

  std::unique_ptr<Subscription> open(const Node& node, const std::string& topic,
                                     const MessageType& type, Qos qos, Node::RawCallback callback,
                                     Writers writers = {});
  void close(Subscription& subscription);
  /// [ns] clock of the timers
  std::int64_t timer_now_ns() const {
    return time.on ? time.now_ns
                   : std::chrono::nanoseconds(Steady::now().time_since_epoch()).count();
  }
  void set_time(std::int64_t now_ns);
  /// Lock step needs one order of all that is heard.
  void require_one_port(const char* call) const;
  void wait(double timeout_s);
  /// @return whether a turn, or an answer to one, came within timeout_s
  bool wait_for_turn(Subscription& subscription, double timeout_s);
  void run_due_timers(const Node& node);
  /// [ns] since a message arrived, while the node's thread was busy
  std::int64_t waited_ns(const dds::SampleInfo& info) const;
  /// @return messages taken; limited, so that a flood on one topic does not starve the others
  int take_some(const Node& node, Subscription& subscription);
  Qos guard(Subscription& subscription, Qos qos, const MessageType& type, Writers writers);
  /// Hands a decoded message, in subscription.object, to whom it is for, if its writer is heard.
  void hear(const Node& node, Subscription& subscription, const dds::SampleInfo& info);
  void deliver_newest(const Node& node, Subscription& subscription);
  static void keep(Subscription& subscription, const MessageInfo& info);
  void deliver_kept(const Node& node, Subscription& subscription);
  /// Delivers what was kept of writers that have become the one that is heard.
  void look_at_kept(const Node& node);
  /// One pass: some messages of every subscription, then what was deferred.
  /// @return whether there were any
  bool serve(const Node& node);
  /// Takes until nothing is left.
  void drain(const Node& node);
  void follow(const Node& node, double timeout_s);
  void lead(const Node& node);
  bool give_turn(const Node& node, std::size_t follower);
  void call_the_roll(const Node& node);
  void settle() const;
  /// An exception is a bug of the component: logged, then left to end the process.
  template <typename Callback, typename... Arguments>
  void call(const Node& node, const std::string& what, const Callback& callback,
            const Arguments&... arguments);
};

template <typename Callback, typename... Arguments>
void Node::Impl::call(const Node& node, const std::string& what, const Callback& callback,
                      const Arguments&... arguments) {
  try {
    callback(arguments...);
  } catch (const std::exception& e) {
    node.log_->critical("the callback of {} threw: {}. This is a bug; the process ends", what,
                        e.what());
    throw;
  }
}

}  // namespace goshawk::runtime
