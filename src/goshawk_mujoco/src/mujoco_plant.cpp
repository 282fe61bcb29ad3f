#include "goshawk/mujoco/mujoco_plant.hpp"

#include <mujoco/mujoco.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>

namespace goshawk::mujoco {
namespace {

using plant::PlantState;
using plant::VehicleParameters;
using Vec4 = Vec4;

constexpr int kSubsteps = 2;
constexpr int kBody = 1;  // 0 is the world
constexpr const char* kFile = "vehicle.xml";

struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

template <typename... Numbers>
std::string format(const char* form, Numbers... numbers) {
  char text[400];
  std::snprintf(text, sizeof text, form, numbers...);
  return text;
}

// A rotor twists the body against its own sense of turning: the sign of kTwist. Order and senses as
// in simulator::Mixer: front left, rear left, rear right, front right.
std::string model_text(const VehicleParameters& p) {
  const double lever_m = p.arm_length_m / std::sqrt(2.0);
  const double twist_m = p.torque_coefficient_nm_s2 / p.thrust_coefficient_n_s2;
  constexpr int kX[] = {1, -1, -1, 1}, kY[] = {1, 1, -1, -1}, kTwist[] = {1, -1, 1, -1};
  std::string sites, motors;
  for (int i = 0; i < 4; ++i) {
    sites +=
        format("<site name='rotor%d' pos='%.17g %.17g 0'/>", i, kX[i] * lever_m, kY[i] * lever_m);
    motors += format("<motor site='rotor%d' gear='0 0 1 0 0 %.17g'/>", i, kTwist[i] * twist_m);
  }
  return "<mujoco><compiler inertiafromgeom='false'/>" +
         format("<option gravity='0 0 %.17g' integrator='Euler'/>", -kGravity_m_s2) +
         "<worldbody><body name='vehicle'><freejoint/>" +
         format(
             "<inertial pos='0 0 0' mass='%.17g' fullinertia='%.17g %.17g %.17g %.17g %.17g "
             "%.17g'/>",
             p.mass_kg, p.inertia_xx_kg_m2, p.inertia_yy_kg_m2, p.inertia_zz_kg_m2,
             p.inertia_xy_kg_m2, p.inertia_xz_kg_m2, p.inertia_yz_kg_m2) +
         sites + "</body></worldbody><actuator>" + motors + "</actuator></mujoco>";
}

mjModel* load(const std::string& text) {
  mjVFS files;
  mj_defaultVFS(&files);
  if (mj_makeEmptyFileVFS(&files, kFile, int(text.size())) != 0) {
    throw std::runtime_error("MuJoCo has no room for a model of its own");
  }
  std::memcpy(files.filedata[mj_findFileVFS(&files, kFile)], text.data(), text.size());
  char error[300] = "";
  mjModel* model = mj_loadXML(kFile, &files, error, sizeof error);
  mj_deleteVFS(&files);
  if (model == nullptr) throw std::runtime_error(std::string("MuJoCo refused the model: ") + error);
  return model;
}

class MujocoPlant : public plant::PlantModel {
 public:
  explicit MujocoPlant(const VehicleParameters& parameters)
      : p_(parameters), model_(load(model_text(parameters))), data_(mj_makeData(model_.get())) {
    if (data_ == nullptr) throw std::runtime_error("MuJoCo could not make the model's data");
  }

  void reset(const PlantState& state) override {
    mj_resetData(model_.get(), data_.get());
    state_ = state;
    const auto& s = state.body;
    const auto& q = s.q_map_base;
    const mjtNum position[7] = {
        s.position_map.x(), s.position_map.y(), s.position_map.z(), q.w(), q.x(), q.y(), q.z()};
    std::memcpy(data_->qpos, position, sizeof position);
    Eigen::Map<Vec3>(data_->qvel) = s.velocity_map;
    Eigen::Map<Vec3>(data_->qvel + 3) = s.angular_velocity_base;
  }

  void step(const Vec4& rotor_command_rad_s, const Vec3& wind_map, double dt_s) override {
    model_->opt.timestep = dt_s / kSubsteps;
    const double decay = std::exp(-model_->opt.timestep / p_.motor_time_constant_s);
    for (int i = 0; i < kSubsteps; ++i) {
      auto& speed = state_.rotor_speed_rad_s;
      speed = rotor_command_rad_s + decay * (speed - rotor_command_rad_s);
      apply_forces(wind_map);
      mj_step(model_.get(), data_.get());
      read_state();
    }
  }

  const PlantState& state() const override { return state_; }

  Vec3 acceleration_map(const Vec3& wind_map) const override {
    apply_forces(wind_map);
    mj_forward(model_.get(), data_.get());
    return Eigen::Map<const Vec3>(data_->qacc);
  }

  const char* name() const override { return "mujoco_2.2"; }

 private:
  void apply_forces(const Vec3& wind_map) const {
    Eigen::Map<Vec4>(data_->ctrl) =
        p_.thrust_coefficient_n_s2 * state_.rotor_speed_rad_s.cwiseAbs2();
    const auto& s = state_.body;
    const Vec3 air_map = s.velocity_map - wind_map;
    const Vec3 up_map = s.q_map_base * Vec3::UnitZ();
    // Rotor drag: one coefficient along the body's axis, another across it.
    const Vec3 along_map = up_map.dot(air_map) * up_map;
    Eigen::Map<Vec3>(data_->xfrc_applied + 6 * kBody) =
        -p_.linear_drag_z_kg_s * along_map - p_.linear_drag_xy_kg_s * (air_map - along_map) -
        p_.quadratic_drag_kg_m * air_map.norm() * air_map;
  }

  void read_state() {
    const mjtNum* q = data_->qpos;
    auto& s = state_.body;
    s.position_map = Eigen::Map<const Vec3>(q);
    s.q_map_base = Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized();
    s.velocity_map = Eigen::Map<const Vec3>(data_->qvel);
    s.angular_velocity_base = Eigen::Map<const Vec3>(data_->qvel + 3);
  }

  VehicleParameters p_;
  std::unique_ptr<mjModel, FreeModel> model_;
  std::unique_ptr<mjData, FreeData> data_;
  PlantState state_;
};

}  // namespace

std::unique_ptr<plant::PlantModel> make_mujoco_plant(const VehicleParameters& parameters) {
  return std::make_unique<MujocoPlant>(parameters);
}

}  // namespace goshawk::mujoco
