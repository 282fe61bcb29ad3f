#include "flight/mission_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "flight/pilot.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/mission_messages/messages.hpp"

namespace goshawk::cli {
namespace {

namespace constants = goshawk_msgs::msg::MissionState_Constants;
using introspection::Interruptible;
using Clock = std::chrono::steady_clock;

double since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

bool is_over(const MissionWatch::State& m) {
  return m.state() == constants::STATE_DONE || m.state() == constants::STATE_FAILED ||
         m.state() == constants::STATE_CANCELLED;
}

}  // namespace

std::string progress_line(const MissionWatch::State& m) {
  if (m.state() == constants::STATE_NONE) return "no mission yet";
  std::string line = fmt::format("{}, waypoint {} of {}, {:.1f} m left",
                                 to_string(mission::mission_state_of(m.state())), m.waypoint(),
                                 m.waypoints(), m.distance_left());
  if (m.state() == constants::STATE_WAITING) line += fmt::format(", for {:.1f} s", m.hold_left());
  if (!m.message().empty()) line += ": " + m.message();
  return line;
}

MissionWatch::MissionWatch(introspection::Session& session, const std::string& space)
    : session_(session), topic_(topic_in(space, "mission_state")) {
  session.node().subscribe<State>(topic_, runtime::Qos::latched(),
                                  [this](const State& m, const auto&) {
                                    state_ = m;
                                    ++heard_;
                                  });
}

Result<MissionWatch::State> MissionWatch::newest(double timeout_s) {
  session_.wait_for(timeout_s, [this] { return state_.has_value(); });
  if (state_) return *state_;
  if (Interruptible::interrupted()) return fail(ErrorCode::cancelled, "interrupted");
  return fail(ErrorCode::stage_silent,
              fmt::format("no stage that flies missions is heard on {} in domain {} (waited {:g} "
                          "s): start one with goshawk launch flight_mission, or with goshawk run "
                          "mission beside a flight",
                          topic_, session_.context().domain(), timeout_s));
}

Result<MissionWatch::State> MissionWatch::follow(std::uint64_t id, double timeout_s,
                                                 const Tell& tell) {
  const auto begin = Clock::now();
  auto heard_at = Clock::now();
  std::string said;  // state and waypoint
  while (since_s(begin) < timeout_s && !Interruptible::interrupted()) {
    const std::uint64_t before = heard_;
    session_.wait_for(std::min(1.0, std::max(0.01, timeout_s - since_s(begin))),
                      [&] { return heard_ > before; });
    if (heard_ > before) heard_at = Clock::now();
    if (since_s(heard_at) > kSilence_s) {
      return fail(
          ErrorCode::stage_silent,
          fmt::format("the stage that flies the mission has been silent for {:g} s", kSilence_s));
    }
    if (!state_) continue;
    if (state_->id() != id) {
      if (state_->id() < id) continue;  // it has not begun yet
      return fail(ErrorCode::cancelled, "another mission took its place");
    }
    const std::string now =
        fmt::format("{} {} {}", state_->state(), state_->waypoint(), state_->code());
    tell(progress_line(*state_), std::exchange(said, now) != now);
    if (is_over(*state_)) return *state_;
  }
  if (Interruptible::interrupted()) {
    return fail(
        ErrorCode::cancelled,
        "interrupted: the mission flies on (goshawk hold stops the vehicle, goshawk mission "
        "watches, goshawk mission --cancel ends it)");
  }
  return fail(
      ErrorCode::deadline_exceeded,
      fmt::format("not done within {:g} s: the mission flies on (goshawk mission watches it)",
                  timeout_s));
}

}  // namespace goshawk::cli
