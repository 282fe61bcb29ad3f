#include "both.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace goshawk::px4_stand_in {
namespace {

constexpr std::int64_t kTick_ns = std::int64_t(Airframe::kStep_s * 1e9);
constexpr int kTicksPerStep = 5;       // the bridge's 50 Hz
constexpr int kTicksPerFallback = 12;  // the tracker's 20 Hz

}  // namespace

/// Messages of both directions, delivered where they go; none while the bridge does not run.
struct Both::Pipes : px4::Link, Wire {
  explicit Pipes(Both& owner) : both(owner) {}

  template <typename Message>
  void to_autopilot(const Message& m) {
    both.autopilot_->hear(m);
  }
  void send(const px4::VehicleCommand& m) override { to_autopilot(m); }
  void send(const px4::OffboardControlMode& m) override { to_autopilot(m); }
  void send(const px4::TrajectorySetpoint& m) override { to_autopilot(m); }
  void send(const px4::VehicleAttitudeSetpoint& m) override { to_autopilot(m); }
  void send(const px4::MessageFormatRequest& m) override { to_autopilot(m); }
  void send(const px4::RegisterExtComponentRequest& m) override { to_autopilot(m); }
  void send(const px4::ArmingCheckReply& m) override { to_autopilot(m); }
  void send(const px4::VehicleControlMode& m) override { to_autopilot(m); }
  void send(const px4::SetpointConfig& m) override { to_autopilot(m); }
  void tell(const Error& fault) override { told.push_back(fault); }

  bool on() const { return both.bridge_runs && both.bridge_ != nullptr; }
  template <typename Message>
  void to_bridge(const Message& m) {
    if (on()) both.bridge_->hear(m);
  }
  template <typename Message>
  void to_bridge_now(const Message& m) {
    if (on()) both.bridge_->hear(m, both.now_ns_);
  }
  void send(const px4::VehicleStatus& m) override { to_bridge_now(m); }
  void send(const px4::VehicleLandDetected& m) override { to_bridge(m); }
  void send(const px4::BatteryStatus& m) override { to_bridge(m); }
  void send(const px4::FailsafeFlags& m) override { to_bridge(m); }
  void send(const px4::ManualControlSetpoint& m) override { to_bridge(m); }
  void send(const px4::VehicleLocalPosition& m) override { to_bridge_now(m); }
  void send(const px4::VehicleOdometry& m) override {
    if (on()) both.given_ = both.bridge_->hear(m, both.now_ns_);
  }
  void send(const px4::VehicleCommandAck& m) override { to_bridge(m); }
  void send(const px4::MessageFormatResponse& m) override { to_bridge(m); }
  void send(const px4::RegisterExtComponentReply& m) override { to_bridge_now(m); }
  void send(const px4::ArmingCheckRequest& m) override { to_bridge_now(m); }
  void send(const px4::SetpointConfigReply& m) override { to_bridge(m); }

  Both& both;
  std::vector<Error> told;
};

Both::Both(const px4::Config& bridge, const Config& autopilot)
    : bridge_config_(bridge), pipes_(std::make_unique<Pipes>(*this)) {
  if (auto status = px4::check(bridge); !status) throw std::logic_error(status.error().message);
  auto made = Autopilot::create(autopilot, *pipes_, now_ns_);
  if (!made) throw std::logic_error(made.error().message);
  autopilot_ = std::make_unique<Autopilot>(*std::move(made));
  restart_bridge();
}

Both::~Both() = default;

void Both::restart_bridge() {
  bridge_ = std::make_unique<px4::Bridge>(bridge_config_, *pipes_, seed_ += 1000);
  given_.reset();
}

void Both::run(double seconds, const std::function<void()>& each) {
  const auto ticks = std::llround(seconds / Airframe::kStep_s);
  for (std::int64_t i = 0; i < ticks; ++i) {
    now_ns_ += kTick_ns;
    autopilot_->advance(now_ns_);
    const std::int64_t tick = now_ns_ / kTick_ns;
    if (tracker_runs && tick % kTicksPerFallback == 0) track();
    if (bridge_runs && tick % kTicksPerStep == 0) bridge_->step(now_ns_);
    if (each) each();
  }
}

bool Both::run_until(const std::function<bool()>& condition, double most_s) {
  for (double t = 0.0; t < most_s; t += 0.02) {
    if (condition()) return true;
    run(0.02);
  }
  return condition();
}

void Both::track() {
  if (!given_ || !bridge_runs) return;
  if (!track_from_) {
    track_from_ = given_->state.position_map;
    track_begin_ns_ = now_ns_;
  }
  bridge_->hear(fallback(), now_ns_);
}

// A cosine: x from 0 to length_m and back, fastest in the middle.
FlatState Both::reference() const {
  const double rate = 2.0 * speed_m_s / length_m;
  const double angle = rate * double(now_ns_ - track_begin_ns_) * 1e-9;
  FlatState state{.position = *track_from_};
  state.position.x() += 0.5 * length_m * (1.0 - std::cos(angle));
  state.velocity.x() = 0.5 * length_m * rate * std::sin(angle);
  state.acceleration.x() = 0.5 * length_m * rate * rate * std::cos(angle);
  return state;
}

// 0.15 s on along the reference, then straight to rest.
FallbackStop Both::fallback() const {
  const FlatState now = reference();
  const double v = now.velocity.x();
  constexpr double kOn_s = 0.15, kBrake_m_s2 = 2.0;
  const double brake_s = std::max(0.1, std::abs(v) / kBrake_m_s2);
  FallbackStop stop{.step_s = kOn_s, .states = {now}};
  const double rate = 2.0 * speed_m_s / length_m;
  const double angle = rate * (double(now_ns_ - track_begin_ns_) * 1e-9 + kOn_s);
  FlatState on = now;
  on.position.x() = track_from_->x() + 0.5 * length_m * (1.0 - std::cos(angle));
  on.velocity.x() = 0.5 * length_m * rate * std::sin(angle);
  on.acceleration.x() = 0.5 * length_m * rate * rate * std::cos(angle);
  stop.states.push_back(on);
  FlatState rest{.position = on.position};
  rest.position.x() += 0.5 * on.velocity.x() * brake_s;
  // Equal steps: the end of the braking is a multiple of them.
  const int steps = int(std::ceil(brake_s / kOn_s));
  for (int i = 1; i < steps; ++i) {
    const double share = double(i) / steps;
    FlatState between{.position = on.position};
    between.position.x() += on.velocity.x() * brake_s * (share - 0.5 * share * share);
    between.velocity.x() = on.velocity.x() * (1.0 - share) * brake_s / (steps * kOn_s);
    stop.states.push_back(between);
  }
  stop.states.push_back(rest);
  return stop;
}

bool Both::told_of(const std::string& words) const {
  for (const auto& fault : pipes_->told) {
    if (fault.message.find(words) != std::string::npos) return true;
  }
  return false;
}

}  // namespace goshawk::px4_stand_in
