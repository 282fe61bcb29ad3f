#include "goshawk/flight_report/map_timeline.hpp"

#include <cmath>
#include <utility>

namespace goshawk::flight_report {

void MapTimeline::take(double t_s, VoxelGrid grid) {
  const bool again =
      newest_ && newest_->version == grid.version && newest_->geometry == grid.geometry;
  if (again) return;
  newest_ = std::move(grid);
  keep(t_s);
}

Status MapTimeline::take(double t_s, const GridUpdate& update) {
  if (!newest_ || newest_->version != update.from_version) return success();
  if (auto applied = apply(*newest_, update); !applied) return applied;
  keep(t_s);
  return success();
}

void MapTimeline::keep(double t_s) {
  newest_t_s_ = t_s;
  if (!kept_.empty() && !(t_s - kept_.back().t_s >= step_s_)) return;
  if (kept_.size() >= most_) {
    std::vector<MapMoment> half;
    for (std::size_t k = 0; k < kept_.size(); k += 2) half.push_back(std::move(kept_[k]));
    kept_ = std::move(half);
    step_s_ *= 2.0;
    if (t_s - kept_.back().t_s < step_s_) return;
  }
  kept_.push_back({t_s, *newest_, {}});
}

std::vector<MapMoment> MapTimeline::moments() const {
  std::vector<MapMoment> moments = kept_;
  if (newest_ && !moments.empty() && newest_t_s_ > moments.back().t_s) {
    moments.push_back({newest_t_s_, *newest_, {}});
  }
  return moments;
}

std::vector<MapMoment> spread(const std::vector<MapMoment>& moments, std::size_t count) {
  if (count >= moments.size()) return moments;
  if (count == 1) return {moments.back()};
  std::vector<MapMoment> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    const double at = double(k) * double(moments.size() - 1) / double(count - 1);
    chosen.push_back(moments[std::size_t(std::lround(at))]);
  }
  return chosen;
}

}  // namespace goshawk::flight_report
