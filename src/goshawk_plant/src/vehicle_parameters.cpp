#include "goshawk/plant/vehicle_parameters.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace goshawk::plant {
namespace {

class Faults {
 public:
  void add(const std::string& fault) { text_ += (text_.empty() ? "" : "; ") + fault; }

  bool positive(const char* name, double value) {
    if (std::isfinite(value) && value > 0.0) return true;
    add(fmt::format("{} is {:.6g}: it must be finite and above zero", name, value));
    return false;
  }

  void not_negative(const char* name, double value) {
    if (std::isfinite(value) && value >= 0.0) return;
    add(fmt::format("{} is {:.6g}: it must be finite and not below zero", name, value));
  }

  Status status() const {
    if (text_.empty()) return success();
    return fail(ErrorCode::invalid_parameter, "physically invalid vehicle: " + text_);
  }

 private:
  std::string text_;
};

// A rigid body's principal moments are sums of two of three non-negative numbers (the second
// moments of its mass), so each is at most the sum of the other two.
void check_inertia(const Eigen::Matrix3d& inertia, Faults& faults) {
  if (!inertia.allFinite()) {
    faults.add("the inertia has an entry that is not finite");
    return;
  }
  const Vec3 moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly)
          .eigenvalues();  // in increasing order
  if (!(moments[0] > 0.0)) {
    faults.add(
        fmt::format("the inertia is not positive definite: its smallest principal moment is "
                    "{:.6g} kg m^2",
                    moments[0]));
  } else if (moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-12)) {
    faults.add(
        fmt::format("the inertia breaks the triangle inequality: its largest principal moment, "
                    "{:.6g} kg m^2, is above the sum of the other two",
                    moments[2]));
  }
}

}  // namespace

Eigen::Matrix3d VehicleParameters::inertia_kg_m2() const {
  Eigen::Matrix3d inertia;
  inertia << inertia_xx_kg_m2, inertia_xy_kg_m2, inertia_xz_kg_m2,  //
      inertia_xy_kg_m2, inertia_yy_kg_m2, inertia_yz_kg_m2,         //
      inertia_xz_kg_m2, inertia_yz_kg_m2, inertia_zz_kg_m2;
  return inertia;
}

Status VehicleParameters::check() const {
  Faults faults;
  const bool has_mass = faults.positive("mass_kg", mass_kg);
  check_inertia(inertia_kg_m2(), faults);
  faults.positive("arm_length_m", arm_length_m);
  const bool has_thrust = faults.positive("max_motor_thrust_n", max_motor_thrust_n);
  faults.positive("thrust_coefficient_n_s2", thrust_coefficient_n_s2);
  faults.positive("torque_coefficient_nm_s2", torque_coefficient_nm_s2);
  faults.positive("motor_time_constant_s", motor_time_constant_s);
  faults.not_negative("linear_drag_xy_kg_s", linear_drag_xy_kg_s);
  faults.not_negative("linear_drag_z_kg_s", linear_drag_z_kg_s);
  faults.not_negative("quadratic_drag_kg_m", quadratic_drag_kg_m);
  if (has_mass && has_thrust && !(max_thrust_n() > weight_n())) {
    faults.add(
        fmt::format("four motors of max_motor_thrust_n give {:.6g} N, which does not lift a "
                    "weight of {:.6g} N",
                    max_thrust_n(), weight_n()));
  }
  return faults.status();
}

}  // namespace goshawk::plant
