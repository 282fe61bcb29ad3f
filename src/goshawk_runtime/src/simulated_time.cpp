#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/runtime/lock_step.hpp"
#include "node_impl.hpp"
#include "rosgraph_msgs.h"

namespace goshawk::runtime {
namespace {

using goshawk_msgs::msg::Turn;

constexpr const char* kDone = "/turn_done";
constexpr double kAskAgain_s = 0.5;  // a follower that died may come back under the same name
// Followers count as having found each other once their leader has found nothing new for so long.
constexpr std::chrono::milliseconds kQuiet{1000};
constexpr std::chrono::seconds kMostSettling{10};  // strangers may come and go all the time

std::string turn_topic(const std::string& full_name) {
  return full_name + "/turn";
}

}  // namespace

std::vector<std::string> split_names(std::string_view names) {
  std::vector<std::string> parts(1);
  for (const char c : names) {
    if (c == ',') {
      parts.emplace_back();
    } else if (c != ' ') {
      parts.back() += c;
    }
  }
  std::erase(parts, "");
  return parts;
}

void Node::Impl::set_time(std::int64_t now_ns) {
  // The first time, or a simulation that was restarted: timers count from here.
  if (time.now_ns == 0 || now_ns < time.now_ns) {
    for (auto& timer : timers) timer.next_ns = now_ns + timer.period_ns;
  }
  time.now_ns = now_ns;
}

void Node::Impl::require_one_port(const char* call) const {
  if (!has_own_ports) return;
  throw std::logic_error(
      fmt::format("Node::{}() must come before subscriptions: a reader with a port of "
                  "its own does not hear in the order of turns",
                  call));
}

void Node::use_simulated_time() {
  if (impl_->time.on) return;
  impl_->time.on = true;
  subscribe<rosgraph_msgs::msg::Clock>("/clock", Qos::best_effort(),
                                       [this](const auto& m, const MessageInfo&) {
                                         impl_->set_time(conversions::to_ns(m.clock()));
                                         impl_->run_due_timers(*this);
                                       });
}

void Node::run_in_lock_step() {
  auto& time = impl_->time;
  if (time.takes_turns) return;
  impl_->require_one_port("run_in_lock_step");
  time.on = time.takes_turns = true;
  time.turns_done = advertise<Turn>(kDone, Qos::reliable_last(100));
  time.turns =
      impl_->open(*this, turn_topic(full_name()), message_type<Turn>(), Qos::reliable_last(),
                  [this](const void* message, const MessageInfo&) { take_turn(message); });
  impl_->turn_wait_set.attach_condition(time.turns->reader->get_statuscondition());
}

// One turn: sets the time, runs all due timers, serves all messages, and answers.
void Node::take_turn(const void* message) {
  auto& time = impl_->time;
  Turn turn = *static_cast<const Turn*>(message);
  // The leader asks again if the answer is late; the turn is not run twice.
  if (turn.number() != time.last_turn) {
    time.last_turn = turn.number();
    impl_->set_time(conversions::to_ns(turn.clock()));
    impl_->run_due_timers(*this);
    impl_->drain(*this);
  }
  turn.node(full_name());
  if (!impl_->stopping && !time.turns_done.publish_raw(&turn)) {
    log_->error("the answer to turn {} could not be sent", turn.number());
  }
}

void Node::Impl::drain(const Node& node) {
  while (!stopping && serve(node)) {
  }
}

void Node::Impl::follow(const Node& node, double timeout_s) {
  if (wait_for_turn(*time.turns, timeout_s)) take_some(node, *time.turns);
}

void Node::lead_lock_step(const LockStep& lock_step) {
  if (!(lock_step.step_s >= 1e-6 && lock_step.step_s <= 1.0) || !(lock_step.speed >= 0.0)) {
    throw std::invalid_argument(
        "Node::lead_lock_step: the step must be 1e-6 to 1 s, the speed at least 0");
  }
  impl_->require_one_port("lead_lock_step");
  auto& time = impl_->time;
  time.leads = true;
  const std::string prefix = args_.node_namespace == "/" ? "" : args_.node_namespace;
  for (const auto& name : lock_step.followers) {
    time.followers.push_back(name.starts_with('/') ? name : prefix + "/" + name);
    // Followers need no old turns; a recorder that starts late gets those since the roll call.
    time.turns_of.push_back(advertise<Turn>(turn_topic(time.followers.back()), Qos::latched(100)));
  }
  time.on = true;
  time.now_ns = kFirst_ns;
  time.step_ns = std::llround(lock_step.step_s * 1e9);
  time.speed = lock_step.speed;
  time.clock = advertise<rosgraph_msgs::msg::Clock>("/clock", Qos::reliable_last());
  time.answers = impl_->open(*this, kDone, message_type<Turn>(), Qos::reliable_last(100),
                             [this](const void* message, const MessageInfo&) {
                               const auto& turn = *static_cast<const Turn*>(message);
                               impl_->time.answered = {turn.node(), turn.number()};
                             });
  impl_->turn_wait_set.attach_condition(time.answers->reader->get_statuscondition());
}

// @return false if the node is stopping
bool Node::Impl::give_turn(const Node& node, std::size_t follower) {
  Turn turn;
  turn.clock(conversions::to_stamp(time.now_ns));
  turn.number(++time.turn);
  const std::string& name = time.followers[follower];
  for (int asked = 0; !stopping; ++asked) {
    if (time.begun && asked == 2) {
      node.log_->error("{} does not answer in lock step: simulated time waits for it", name);
    }
    if (!time.turns_of[follower].publish_raw(&turn)) {
      node.log_->error("a turn could not be given to {}", name);
    }
    const auto until = Steady::now() + std::chrono::duration<double>(kAskAgain_s);
    for (auto left = until - Steady::now(); left.count() > 0 && !stopping;
         left = until - Steady::now()) {
      if (wait_for_turn(*time.answers, std::chrono::duration<double>(left).count())) {
        take_some(node, *time.answers);
      }
      if (time.answered == std::pair{name, time.turn}) return true;
    }
  }
  return false;
}

void Node::Impl::settle() const {
  const auto end = Steady::now() + kMostSettling;
  auto changed = Steady::now();
  for (std::size_t known = 0; !stopping && Steady::now() < std::min(end, changed + kQuiet);) {
    if (const auto now = context.listener.known(); now != known) {
      known = now;
      changed = Steady::now();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

// Simulated time begins when every follower is there and has found the others.
void Node::Impl::call_the_roll(const Node& node) {
  for (std::size_t i = 0; i < time.followers.size(); ++i) {
    if (!give_turn(node, i)) return;
  }
  settle();
  drain(node);
  time.begun = true;
  time.next_step = Steady::now();
}

void Node::Impl::lead(const Node& node) {
  if (!time.begun) return call_the_roll(node);
  if (time.speed > 0.0) {
    std::this_thread::sleep_until(time.next_step);
    time.next_step += std::chrono::nanoseconds(std::llround(double(time.step_ns) / time.speed));
    time.next_step = std::max(time.next_step, Steady::now());
  }
  set_time(time.now_ns + time.step_ns);
  rosgraph_msgs::msg::Clock clock;
  clock.clock(conversions::to_stamp(time.now_ns));
  if (!time.clock.publish_raw(&clock)) node.log_->error("/clock could not be published");
  run_due_timers(node);
  for (std::size_t i = 0; i < time.followers.size(); ++i) {
    if (!give_turn(node, i)) return;
  }
  drain(node);
}

}  // namespace goshawk::runtime
