#include "goshawk/flight_check/solid.hpp"

namespace goshawk::flight_check {

Status Solid::check() const {
  const bool finite = center_map.allFinite() && size_m.allFinite();
  const bool round = is_box || size_m.x() == size_m.y();
  if (finite && round && size_m.minCoeff() > 0.0) return success();
  return fail(ErrorCode::invalid_input,
              "a solid at " + to_text(center_map) + " m is " + to_text(size_m) +
                  " m large: edges must be finite and above zero, and a cylinder round");
}

}  // namespace goshawk::flight_check
