#include "flight/why_json.hpp"

namespace goshawk::cli {

Json to_json(const why::Reason& reason) {
  Json object;
  object["binds"] = why::to_string(reason.binds);
  object["doing"] = reason.doing;
  object["because"] = reason.because;
  object["mend"] = reason.mend;
  object["stage"] = reason.stage ? Json(to_string(*reason.stage)) : Json(nullptr);
  object["parameter"] = reason.parameter.empty() ? Json(nullptr) : Json(reason.parameter);
  object["voxel"] = nullptr;
  if (reason.voxel) {
    const auto& voxel = *reason.voxel;
    object["voxel"] = {{"index", {voxel.index.x, voxel.index.y, voxel.index.z}},
                       {"center", to_json(voxel.center_map)},
                       {"known", voxel.known},
                       {"distance_m", to_json(voxel.distance_m)}};
  }
  return object;
}

}  // namespace goshawk::cli
