#include "turns.hpp"

#include <chrono>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/introspection/interruptible.hpp"
#include "goshawk_msgs.h"
#include "rosgraph_msgs.h"

namespace goshawk::recording {
namespace {

using goshawk_msgs::msg::Turn;
using introspection::Interruptible;
using Clock = std::chrono::steady_clock;

constexpr double kAskAgain_s = 0.5;  // a node that is asked twice runs its turn once
constexpr int kAsksUntilWord = 10;

}  // namespace

std::string turn_of(const std::string& topic, const std::string& type) {
  if (type != kTurnType || !topic.ends_with(kTurnEnd)) return "";
  return topic.substr(0, topic.size() - std::string(kTurnEnd).size());
}

TurnGiver::TurnGiver(runtime::Node& node, Say say) : node_(node), say_(std::move(say)) {
  node.subscribe<Turn>("/turn_done", runtime::Qos::reliable_last(100),
                       [this](const Turn& m, const runtime::MessageInfo&) {
                         who_ = m.node();
                         number_ = m.number();
                       });
}

Status TurnGiver::give_plant(const runtime::RawPublisher& turns, const Bytes* clock,
                             const std::string& plant) {
  rosgraph_msgs::msg::Clock next;
  if (clock != nullptr && !runtime::decode(*clock, next)) {
    return fail(ErrorCode::invalid_input, "a recorded message on /clock is not a valid Clock");
  }
  Turn turn;
  // Before the first step, the plant's time is the start of simulated time.
  turn.clock(conversions::to_stamp(step_ns_ > 0 ? step_ns_ : runtime::kFirst_ns));
  turn.number(++plant_turn_);
  auto bytes = runtime::encode(turn);
  if (clock != nullptr) step_ns_ = conversions::to_ns(next.clock());
  return give(turns, bytes, plant);
}

Status TurnGiver::give(const runtime::RawPublisher& turns, Bytes& turn,
                       const std::string& follower) {
  Turn m;
  if (!runtime::decode(turn, m)) {
    return fail(ErrorCode::invalid_input,
                "a recorded turn of " + follower + " is not a valid Turn");
  }
  number_ = 0;
  for (int asked = 0; !Interruptible::interrupted(); ++asked) {
    if (asked == kAsksUntilWord) say_(follower + " does not answer: the replay waits for it");
    if (auto status = turns.publish_raw(&turn); !status) return status;
    const auto until = Clock::now() + std::chrono::duration<double>(kAskAgain_s);
    for (double left_s = kAskAgain_s; left_s > 0.0 && !Interruptible::interrupted();
         left_s = std::chrono::duration<double>(until - Clock::now()).count()) {
      node_.spin_some(left_s);
      if (who_ == follower && number_ == m.number()) return success();
    }
  }
  return success();
}

}  // namespace goshawk::recording
