#include "goshawk/core/vector.hpp"

#include <cstdio>

namespace goshawk {

std::string to_text(const Vec3& p) {
  char text[96];
  const bool huge = !(p.cwiseAbs().maxCoeff() < 1e12);  // whose digits would not fit
  std::snprintf(text, sizeof text, huge ? "(%g, %g, %g)" : "(%.3f, %.3f, %.3f)", p.x(), p.y(),
                p.z());
  return text;
}

std::string to_text(Index3 i) {
  return "(" + std::to_string(i.x) + ", " + std::to_string(i.y) + ", " + std::to_string(i.z) + ")";
}

}  // namespace goshawk
