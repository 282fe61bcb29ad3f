#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "goshawk/core/vector.hpp"

namespace goshawk::cli {

using Json = nlohmann::ordered_json;

Json to_json(const Vec3& v);
Json to_json(const std::vector<Vec3>& points);
/// JSON has no infinity and no NaN: they become null.
Json to_json(double value);

}  // namespace goshawk::cli
