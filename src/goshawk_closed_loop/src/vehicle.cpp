#include "goshawk/closed_loop/vehicle.hpp"

#include <stdexcept>

namespace goshawk::closed_loop {
namespace {

constexpr double kStep_s = 0.001;

class PhysicalVehicle : public Vehicle {
 public:
  explicit PhysicalVehicle(simulator::Quadrotor quadrotor) : quadrotor_(std::move(quadrotor)) {}

  std::int64_t time_ns() const override { return quadrotor_.time_ns(); }
  const RigidBodyState& state() const override { return quadrotor_.state(); }
  simulator::Measurement measure() override { return quadrotor_.measure(); }
  Status command(const AttitudeSetpoint& command, const FlatState&) override {
    return quadrotor_.command(command);
  }
  void advance() override {
    if (auto status = quadrotor_.advance(kStep_s); !status) {
      throw std::logic_error(status.error().message);
    }
  }

 private:
  simulator::Quadrotor quadrotor_;
};

// On the reference; between two commands it goes on with the reference's own derivatives.
class IdealVehicle : public Vehicle {
 public:
  explicit IdealVehicle(const Vec3& home_map) {
    reference_.position = home_map;
    state_.position_map = home_map;
  }

  std::int64_t time_ns() const override { return time_ns_; }
  const RigidBodyState& state() const override { return state_; }
  simulator::Measurement measure() override { return {state_, time_ns_}; }
  Status command(const AttitudeSetpoint& command, const FlatState& reference) override {
    reference_ = reference;
    since_s_ = 0.0;
    state_.q_map_base = command.q_map_base.normalized();
    state_.angular_velocity_base = command.angular_velocity_base;
    return success();
  }
  void advance() override {
    time_ns_ += simulator::Quadrotor::kStep_ns;
    since_s_ += kStep_s;
    const FlatState& r = reference_;
    const double t = since_s_;
    state_.position_map =
        r.position + t * (r.velocity + t / 2.0 * (r.acceleration + t / 3.0 * r.jerk));
    state_.velocity_map = r.velocity + t * (r.acceleration + t / 2.0 * r.jerk);
  }

 private:
  FlatState reference_;
  double since_s_ = 0.0;
  RigidBodyState state_;
  std::int64_t time_ns_ = 0;
};

}  // namespace

Result<std::unique_ptr<Vehicle>> make_vehicle(Tracking tracking, const simulator::Config& config,
                                              const Vec3& home_map) {
  auto quadrotor = simulator::Quadrotor::create(config);
  if (!quadrotor) return quadrotor.error();
  if (auto status = quadrotor->reset(home_map, 0.0); !status) return status.error();
  if (tracking == Tracking::ideal) {
    return std::unique_ptr<Vehicle>(std::make_unique<IdealVehicle>(home_map));
  }
  return std::unique_ptr<Vehicle>(std::make_unique<PhysicalVehicle>(*std::move(quadrotor)));
}

}  // namespace goshawk::closed_loop
