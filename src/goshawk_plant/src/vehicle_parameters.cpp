#include "goshawk/plant/vehicle_parameters.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>

namespace goshawk::plant {
namespace {

class Faults {
 public:
  void add(const std::string& fault) { text_ += (text_.empty() ? "" : "; ") + fault; }

  bool positive(const char* name, double value) {
    if (std::isfinite(value) && value > 0.0) return true;
    add(std::string(name) + " is " + number(value) + " and must be finite and above zero");
    return false;
  }

  void not_negative(const char* name, double value) {
    if (std::isfinite(value) && value >= 0.0) return;
    add(std::string(name) + " is " + number(value) + " and must be finite and not below zero");
  }

  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
  }

  Status status() const {
    if (text_.empty()) return success();
    return fail(ErrorCode::invalid_parameter, "the vehicle cannot be: " + text_);
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
    faults.add("the inertia is not positive definite (smallest principal moment " +
               Faults::number(moments[0]) + " kg m^2)");
  } else if (moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-12)) {
    faults.add("the inertia breaks the triangle inequality: its largest principal moment " +
               Faults::number(moments[2]) + " kg m^2 is above the sum of the other two");
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
    faults.add("four motors of max_motor_thrust_n give " + Faults::number(max_thrust_n()) +
               " N, which does not lift a weight of " + Faults::number(weight_n()) + " N");
  }
  return faults.status();
}

}  // namespace goshawk::plant
