#include "goshawk/flight_check/mover_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "clearance.hpp"
#include "input_checks.hpp"
#include "judge.hpp"

namespace goshawk::flight_check {
namespace {

std::string name_of(const movers::Mover& mover) {
  return mover.kind.empty() ? fmt::format("mover {}", mover.id)
                            : fmt::format("mover {} ({})", mover.id, mover.kind);
}

}  // namespace

std::string MoverVerdict::sentence() const {
  const Vec3& p = clearance_place_map;
  if (!touched.empty()) {
    const std::string who =
        touched.size() == 1 ? mover : fmt::format("{} movers, first {},", touched.size(), mover);
    return fmt::format("touched {} at {:.3f} s, near ({:.3f}, {:.3f}, {:.3f})", who, clearance_t_s,
                       p.x(), p.y(), p.z());
  }
  if (std::isinf(clearance_m)) return "touched nothing that moves: nothing does";
  return fmt::format("touched nothing that moves: smallest clearance {:.3f} m at {:.3f} s, from {}",
                     clearance_m, clearance_t_s, mover);
}

void MoverVerdict::add(const MoverVerdict& later) {
  const bool nearer = later.clearance_m < clearance_m;
  for (const std::uint64_t id : later.touched) {
    if (std::ranges::find(touched, id) == touched.end()) touched.push_back(id);
  }
  if (!nearer) return;
  clearance_m = later.clearance_m;
  clearance_t_s = later.clearance_t_s;
  clearance_place_map = later.clearance_place_map;
  mover = later.mover;
}

class MoverCheck::Implementation {
 public:
  Implementation(std::vector<movers::Mover> movers, double start_s, const Body& body,
                 double tolerance_m)
      : movers_(std::move(movers)),
        start_s_(start_s),
        reach_m_(body.reach_m()),
        tolerance_m_(tolerance_m) {
    for (const auto& mover : movers_) {
      const Solid box{true, Vec3::Zero(), 2.0 * mover.half_m};
      meters_.emplace_back(std::span(&box, 1), body);
    }
  }

  MoverVerdict judge(std::span<const Sample> track) const {
    MoverVerdict all;
    for (std::size_t i = 0; i < movers_.size(); ++i) {
      const Motion motion(track, reach_m_, movers_[i].top_point_speed_m_s());
      if (least_m(i, motion, track.front()) >= all.clearance_m) continue;
      take(movers_[i], judge_one(i, motion, all.clearance_m), all);
    }
    return all;
  }

 private:
  // No clearance of the flight from this mover is smaller.
  double least_m(std::size_t i, const Motion& motion, const Sample& first) const {
    const movers::BoxState state = movers_[i].at(first.t_s - start_s_);
    const double apart_m = (state.position_map - first.position_map).norm();
    return apart_m - movers_[i].reach_m() - reach_m_ - motion.moved_m(0.0, motion.end());
  }

  // FCL measures in the mover's own frame: there it stands still.
  Verdict judge_one(std::size_t i, const Motion& motion, double below_m) const {
    const auto measure = [&, i](const Pose& pose, double t_s, double at_most_m) {
      const movers::OrientedBox box = movers_[i].box_at(t_s - start_s_);
      const Pose seen{box.to_box(pose.position_map), box.q_map_box.conjugate() * pose.q_map_base};
      Clearance found = meters_[i].measure(seen, at_most_m);
      found.obstacle_map = box.center_map + box.q_map_box * found.obstacle_map;
      return found;
    };
    return Judge(measure, motion, tolerance_m_, below_m).run();
  }

  static void take(const movers::Mover& mover, const Verdict& v, MoverVerdict& all) {
    const bool first = all.touched.empty();
    const bool sooner = v.touched && (first || v.clearance_t_s < all.clearance_t_s);
    if (v.touched) all.touched.push_back(mover.id);
    if (!sooner && !(first && v.clearance_m < all.clearance_m)) return;
    all.clearance_m = v.clearance_m;
    all.clearance_t_s = v.clearance_t_s;
    all.clearance_place_map = v.clearance_place_map;
    all.mover = name_of(mover);
  }

  std::vector<movers::Mover> movers_;
  std::vector<ClearanceMeter> meters_;  // each a box in its own frame
  double start_s_, reach_m_, tolerance_m_;
};

MoverCheck::MoverCheck(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
MoverCheck::MoverCheck(MoverCheck&&) noexcept = default;
MoverCheck& MoverCheck::operator=(MoverCheck&&) noexcept = default;
MoverCheck::~MoverCheck() = default;

Result<MoverCheck> MoverCheck::create(std::vector<movers::Mover> movers, double start_s,
                                      const Body& body, const Options& options) {
  if (auto status = body.check(); !status) return status.error();
  if (auto status = check_options(options); !status) return status.error();
  if (!std::isfinite(start_s)) {
    return fail(ErrorCode::invalid_parameter, "the start of the movers' time is not finite");
  }
  return MoverCheck(
      std::make_unique<Implementation>(std::move(movers), start_s, body, options.tolerance_m));
}

Result<MoverVerdict> MoverCheck::judge(std::span<const Sample> track) const {
  if (auto status = check_track(track); !status) return status.error();
  return implementation_->judge(track);
}

}  // namespace goshawk::flight_check
