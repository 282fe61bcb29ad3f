#include "flight/pilot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::cli {
namespace {

namespace state = goshawk_msgs::msg::NavigatorState_Constants;
using goshawk_msgs::msg::NavigatorState;
using introspection::Interruptible;
using Steady = std::chrono::steady_clock;

constexpr double kRest_m_s = 0.1;  // a vehicle that hovers is slower
constexpr int kRests = 20;         // messages in a row

double seconds_since(Steady::time_point begin) {
  return std::chrono::duration<double>(Steady::now() - begin).count();
}

}  // namespace

std::string topic_in(const std::string& space, const std::string& name) {
  return space == "/" ? "/" + name : fmt::format("{}/{}", space, name);
}

bool has_guard(const introspection::Session& session, const std::string& space) {
  return std::ranges::any_of(session.endpoints_of(topic_in(space, "guard_verdict")),
                             [](const runtime::EndpointInfo& endpoint) { return endpoint.writer; });
}

Error no_taker(const introspection::Session& session, const std::string& space,
               const std::string& topic, double waited_s) {
  if (has_guard(session, space)) {
    return fail(ErrorCode::stage_silent,
                "the guard flies the vehicle in the navigator's place and takes neither goals nor "
                "commands: command the planner that it guards");
  }
  return fail(ErrorCode::stage_silent,
              fmt::format("no stage reads {} in domain {} (waited {:g} s). Is a flight running, "
                          "with the same ROS_DOMAIN_ID and namespace?",
                          topic, session.context().domain(), waited_s));
}

Pilot::Pilot(introspection::Session& session, const std::string& space, Say say)
    : session_(session),
      say_(std::move(say)),
      space_(space),
      goal_topic_(topic_in(space, "goal_pose")),
      goals_(session.node().advertise<geometry_msgs::msg::PoseStamped>(
          goal_topic_, runtime::Qos::reliable_last())) {
  session.node().subscribe<nav_msgs::msg::Odometry>(
      topic_in(space, "odom"), runtime::Qos::best_effort(), [this](const auto& m, const auto&) {
        const auto odometry = conversions::from_msg(m);
        if (!odometry) return;
        position_map_ = odometry->position_map;
        speed_m_s_ = odometry->velocity_map.norm();
        resting_ = speed_m_s_ < kRest_m_s ? resting_ + 1 : 0;
        yaw_rad_ = yaw_of(odometry->q_map_base);
      });
  session.node().subscribe<NavigatorState>(
      topic_in(space, "navigator_state"), runtime::Qos::latched(20),
      [this](const NavigatorState& m, const auto&) {
        newest_ns_ = std::max(newest_ns_, conversions::to_ns(m.header().stamp()));
        if (conversions::to_ns(m.header().stamp()) > asked_ns_) state_ = m;
      });
}

Status Pilot::wait_ready(double timeout_s) {
  session_.wait_for(timeout_s, [&] { return position_map_ && goals_.matched() > 0; });
  if (Interruptible::interrupted()) return fail(ErrorCode::cancelled, "interrupted");
  if (goals_.matched() == 0) return no_taker(session_, space_, goal_topic_, timeout_s);
  if (!position_map_) {
    return fail(ErrorCode::stage_silent,
                fmt::format("no odometry came in domain {} within {:g} s: the vehicle's position "
                            "is unknown",
                            session_.context().domain(), timeout_s));
  }
  session_.wait_for(0.5,
                    [] { return false; });  // what the navigator said before comes in this time
  // A recorder reads goals as well: behind the guard nobody flies to them.
  if (has_guard(session_, space_)) return no_taker(session_, space_, goal_topic_, timeout_s);
  return success();
}

bool Pilot::is_answered() const {
  return state_ &&
         (state_->state() == state::STATE_ARRIVED || state_->state() == state::STATE_FAILED);
}

void Pilot::tell_progress(const Vec3& goal_map) {
  say_(fmt::format("{}, {:.2f} m to go, {:.2f} m/s",
                   state_ ? conversions::navigator_state_word(state_->state()) : "asked",
                   (*position_map_ - goal_map).norm(), speed_m_s_));
}

Result<Arrival> Pilot::go(const Vec3& goal_map, std::optional<double> yaw_rad, double timeout_s) {
  const double half_yaw_rad = 0.5 * yaw_rad.value_or(yaw_rad_);
  geometry_msgs::msg::PoseStamped goal;
  goal.header(conversions::make_header(session_.node().now_ns()));
  goal.pose().position(conversions::to_point(goal_map));
  goal.pose().orientation().z(std::sin(half_yaw_rad));
  goal.pose().orientation().w(std::cos(half_yaw_rad));
  forget_answers();
  if (auto status = goals_.publish(goal); !status) return status.error();
  return arrive(goal_map, timeout_s);
}

void Pilot::forget_answers() {
  asked_ns_ = newest_ns_;
  state_.reset();
  resting_ = 0;
}

Status Pilot::rest(double timeout_s) {
  session_.wait_for(timeout_s, [this] { return resting_ >= kRests; });
  if (resting_ >= kRests) return success();
  if (Interruptible::interrupted()) return fail(ErrorCode::cancelled, "interrupted");
  return fail(ErrorCode::deadline_exceeded,
              fmt::format("the vehicle does not rest within {:g} s: it flies at {:.2f} m/s",
                          timeout_s, speed_m_s_));
}

Result<Arrival> Pilot::arrive(std::optional<Vec3> sent_map, double timeout_s) {
  const auto goal_of = [&] {
    if (sent_map || !state_) return sent_map.value_or(*position_map_);
    return conversions::from_msg(state_->goal());
  };
  const auto begin = Steady::now();
  while (!is_answered() && seconds_since(begin) < timeout_s && !Interruptible::interrupted()) {
    session_.wait_for(std::min(1.0, timeout_s - seconds_since(begin)),
                      [this] { return is_answered(); });
    if (!is_answered()) tell_progress(goal_of());
  }
  if (is_answered()) {
    if (state_->state() == state::STATE_FAILED) {
      return fail(conversions::error_code_of(state_->code()), state_->message());
    }
    return Arrival{goal_of(), (*position_map_ - goal_of()).norm(), seconds_since(begin)};
  }
  if (Interruptible::interrupted()) {
    return fail(ErrorCode::cancelled,
                "interrupted: the vehicle flies on to its goal (goshawk hold stops it)");
  }
  return fail(ErrorCode::deadline_exceeded,
              fmt::format("not there within {:g} s: the vehicle flies on (goshawk hold stops it; "
                          "--timeout waits longer)",
                          timeout_s));
}

}  // namespace goshawk::cli
