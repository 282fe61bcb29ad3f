#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "goshawk/runtime/clock.hpp"
#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/live_parameters.hpp"
#include "goshawk/runtime/lock_step.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "goshawk/runtime/parameters.hpp"
#include "goshawk/runtime/qos.hpp"
#include "goshawk/runtime/ros_args.hpp"
#include "goshawk/runtime/writers.hpp"

namespace spdlog {
class logger;
}

namespace goshawk::runtime {

/// Thrown while a component is constructed from what the user gave (parameters, a map file): the
/// container prints the sentence and ends with status 2.
class StartupFault : public std::runtime_error {
 public:
  explicit StartupFault(Error error)
      : std::runtime_error(error.message), error_(std::move(error)) {}
  const Error& error() const { return error_; }

 private:
  Error error_;
};

struct MessageInfo {
  std::int64_t received_ns = 0;  // [ns] clock of the node, when its thread took the message
  std::int64_t waited_ns = 0;    // [ns] before that, since it had arrived; 0 in simulated time
  std::int64_t sent_ns = 0;      // [ns] the sender's system clock, when it was published
  Participant writer{};          // who published it
};

namespace detail {
class Writer;
}  // namespace detail

/// Publishes in the caller's thread, synchronously (asynchronous costs milliseconds at p99).
class RawPublisher {
 public:
  RawPublisher() = default;
  explicit RawPublisher(std::shared_ptr<detail::Writer> writer) : writer_(std::move(writer)) {}
  /// @return io_failed if the middleware did not take the message
  Status publish_raw(const void* message) const;
  /// Readers that discovery has matched: good enough to wait for, no proof that they listen.
  int matched() const;
  /// @return whether every reliable reader that is matched has the messages, within timeout_s
  bool wait_acknowledged(double timeout_s) const;

 private:
  std::shared_ptr<detail::Writer> writer_;
};

template <typename Message>
class Publisher : public RawPublisher {
 public:
  using RawPublisher::RawPublisher;
  Status publish(const Message& message) const { return publish_raw(&message); }
};

/// A named member of the graph with one thread: every callback of the node runs in spin(), one
/// after another, so a node's state needs no lock and a slow node delays no other.
class Node {
 public:
  Node(Context& context, std::string name, RosArgs args = {},
       std::shared_ptr<const Clock> clock = std::make_shared<SystemClock>());
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  const std::string& name() const { return name_; }
  std::string full_name() const;
  /// [ns] of the clock, or of simulated time: for stamps
  std::int64_t now_ns() const;
  /// [ns] of a clock that nobody sets, or of simulated time: for durations. Whatever flies or times
  /// out counts on this one.
  std::int64_t monotonic_ns() const;
  spdlog::logger& log() { return *log_; }
  /// Of the node's participant: @see Context::refused_datagrams(), last_refusal()
  std::uint64_t refused_datagrams() const;
  std::string last_refusal() const;

  /// Also switches to simulated time or lock step if the user asks for it. From here on the node
  /// answers requests on /parameter_request.
  /// @param reconfigure called between two callbacks with a config that differs only in parameters
  /// marked AtRunTime and is in range: it adopts the whole config or refuses it. Without it no
  /// parameter can change at run time
  /// @throws StartupFault that lists every fault
  template <typename Config>
  Config parameters(std::function<Status(const Config&)> reconfigure = {}) {
    auto source = args_.parameters_of(name_);
    if (!source) throw StartupFault(source.error());
    NodeParameters common;
    auto config = read_parameters<Config>(*source, name_, &common);
    if (!config) throw StartupFault(config.error());
    if (common.lock_step) {
      run_in_lock_step();
    } else if (common.use_sim_time) {
      use_simulated_time();
    }
    serve(std::make_unique<LiveConfig<Config>>(*config, name_, std::move(reconfigure)),
          common.set_parameters);
    return *std::move(config);
  }

  /// From here on now_ns() and timers follow /clock; 0 before the first message on it.
  void use_simulated_time();
  /// From here on the node runs only in the turns that a leader gives it; @see LockStep. Call it
  /// before you subscribe.
  /// @throws std::logic_error a subscription to large messages has a port of its own already
  void run_in_lock_step();
  /// From here on spin() makes simulated time, step by step, for the followers. Before the first
  /// step every follower must have answered. The leader waits for one that falls silent. Call it
  /// before you subscribe.
  /// @throws std::invalid_argument a step outside of 1e-6 to 1 s, or a speed below 0
  /// @throws std::logic_error as run_in_lock_step()
  void lead_lock_step(const LockStep& lock_step);

  template <typename Message>
  Publisher<Message> advertise(std::string_view topic, Qos qos) {
    return Publisher<Message>(make_writer(topic, message_type<Message>(), qos));
  }

  template <typename Message>
  void subscribe(std::string_view topic, Qos qos,
                 std::function<void(const Message&, const MessageInfo&)> callback,
                 Writers writers = {}) {
    subscribe_raw(
        topic, message_type<Message>(), qos,
        [callback = std::move(callback)](const void* message, const MessageInfo& info) {
          callback(*static_cast<const Message*>(message), info);
        },
        std::move(writers));
  }

  using RawCallback = std::function<void(const void* message, const MessageInfo& info)>;
  RawPublisher advertise_raw(std::string_view topic, const MessageType& type, Qos qos) {
    return RawPublisher(make_writer(topic, type, qos));
  }
  void subscribe_raw(std::string_view topic, const MessageType& type, Qos qos, RawCallback callback,
                     Writers writers = {});

  /// Who is told of a process that is not heard, with second_writer; until then the log.
  void on_second_writer(std::function<void(const Error&)> callback);

  /// Calls back every period_s from now on, by the machine's steady clock or by simulated time; a
  /// call that comes late is not made up for.
  void every(double period_s, std::function<void()> callback);

  /// Calls back once, in the node's thread, after the messages that are already here were served:
  /// for work that should see the newest of them first. Call it from a callback.
  void later(std::function<void()> callback);

  /// A node of the same name, namespace and remappings in the same process, to be spun by another
  /// thread: for input that would keep this one waiting. It has the clock of the machine.
  /// @pre not in lock step: what runs at the same time does not repeat
  std::unique_ptr<Node> beside();
  bool in_lock_step() const;

  /// Serves callbacks until stop(). An exception in a callback is a bug: it is logged with the
  /// topic's name, and ends the process, so that supervision restarts it.
  void spin();
  /// Serves what is there or comes within timeout_s, then returns.
  void spin_some(double timeout_s);
  /// From any thread.
  void stop();

 private:
  std::shared_ptr<detail::Writer> make_writer(std::string_view topic, const MessageType& type,
                                              Qos qos);
  void serve(std::unique_ptr<LiveParameters> parameters, ParameterSetters setters);
  void take_turn(const void* message);
  struct Impl;
  explicit Node(const Node& other, std::unique_ptr<Impl> impl);

  std::string name_;
  RosArgs args_;
  std::shared_ptr<const Clock> clock_;
  std::shared_ptr<spdlog::logger> log_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace goshawk::runtime
