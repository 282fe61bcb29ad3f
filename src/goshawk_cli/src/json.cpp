#include "json.hpp"

#include <cmath>

namespace goshawk::cli {

Json to_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json to_json(const Vec3& v) {
  return Json::array({to_json(v.x()), to_json(v.y()), to_json(v.z())});
}

Json to_json(const std::vector<Vec3>& points) {
  Json array = Json::array();
  for (const auto& p : points) array.push_back(to_json(p));
  return array;
}

}  // namespace goshawk::cli
