#include "goshawk/flight_check/body.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk::flight_check {

namespace {

constexpr double kLargest_m = 100.0;

void complain(std::string& faults, const char* name, double value_m) {
  if (value_m > 0.0 && value_m <= kLargest_m) return;  // NaN fails both
  if (!faults.empty()) faults += ", ";
  faults += fmt::format("{} = {}", name, value_m);
}

}  // namespace

Status Body::check() const {
  std::string faults;
  if (is_box) {
    complain(faults, "length_m", length_m);
    complain(faults, "width_m", width_m);
  } else {
    complain(faults, "radius_m", radius_m);
  }
  complain(faults, "height_m", height_m);
  if (faults.empty()) return success();
  return fail(ErrorCode::invalid_parameter,
              "the body has edges outside of (0, 100] m: " + faults + "; give its true size");
}

double Body::reach_m() const {
  const double across_m = is_box ? std::hypot(length_m, width_m) / 2.0 : radius_m;
  return std::hypot(across_m, height_m / 2.0);
}

}  // namespace goshawk::flight_check
