#include "goshawk/tracker/map_guard.hpp"

#include <fmt/format.h>

namespace goshawk::tracker {
namespace {

constexpr int kWayOutSteps = 32;

}  // namespace

Status MapGuard::check(const CommittedTrajectory& committed, double from_s) const {
  if (grid() == nullptr) {
    if (!required_) return success();
    return fail(ErrorCode::no_map,
                fmt::format("trajectory {} refused: no map has come to check it against; is "
                            "map_server running, in this domain and namespace?",
                            committed.id()));
  }
  if (grid()->version < committed.map_version()) {
    return fail(ErrorCode::no_map,
                fmt::format("trajectory {} refused: it was planned in map {}, but the newest map "
                            "that has come here is {}; plan again, or look whether updates of "
                            "map/voxels are lost",
                            committed.id(), committed.map_version(), grid()->version));
  }
  return check_against(space_, committed, from_s);
}

std::optional<double> MapGuard::first_contact(const BezierPiece& curve) const {
  if (grid() == nullptr) return 0.0;
  for (int i = 0; i < kWayOutSteps; ++i) {
    const double t_s = curve.duration_s * i / kWayOutSteps;
    const auto voxel = grid()->geometry.index_of(curve.sample(t_s).position);
    if (!voxel || !space_.is_free(*voxel)) continue;
    const auto found = find_obstruction(space_, curve, t_s);
    return found ? std::optional(found->time_s) : std::nullopt;
  }
  return 0.0;
}

}  // namespace goshawk::tracker
