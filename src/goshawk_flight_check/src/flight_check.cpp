#include "goshawk/flight_check/flight_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "clearance.hpp"
#include "input_checks.hpp"
#include "judge.hpp"
#include "octomap_file.hpp"

namespace goshawk::flight_check {

Status check_gaps(std::span<const Sample> track) {
  double longest_s = 0.0;
  double at_s = 0.0;
  for (std::size_t i = 1; i < track.size(); ++i) {
    const double gap_s = track[i].t_s - track[i - 1].t_s;
    if (gap_s > longest_s) {
      longest_s = gap_s;
      at_s = track[i - 1].t_s;
    }
  }
  if (longest_s <= kLongestGap_s) return success();
  return fail(
      ErrorCode::tracking_lost,
      fmt::format("the track has a gap of {:.2f} s at {:.2f} s, so it cannot be judged: what "
                  "was flown there is not known. Record it on a machine that keeps up",
                  longest_s, at_s));
}

namespace {

std::string sentence_of(const Verdict& v) {
  const Vec3& p = v.clearance_place_map;
  if (v.touched) {
    return fmt::format("touched an obstacle at {:.3f} s, near ({:.3f}, {:.3f}, {:.3f})",
                       v.clearance_t_s, p.x(), p.y(), p.z());
  }
  if (std::isinf(v.clearance_m)) return "touched nothing: the map has no obstacle";
  return fmt::format(
      "touched nothing: smallest clearance {:.3f} m at {:.3f} s, from the obstacle at "
      "({:.3f}, {:.3f}, {:.3f})",
      v.clearance_m, v.clearance_t_s, p.x(), p.y(), p.z());
}

}  // namespace

class FlightCheck::Implementation {
 public:
  Implementation(ClearanceMeter meter, double reach_m, double tolerance_m)
      : meter_(std::move(meter)), reach_m_(reach_m), tolerance_m_(tolerance_m) {}

  Verdict judge(std::span<const Sample> track, double below_m) const {
    const Motion motion(track, reach_m_);
    const auto measure = [this](const Pose& pose, double, double at_most_m) {
      return meter_.measure(pose, at_most_m);
    };
    Verdict verdict = Judge(measure, motion, tolerance_m_, below_m).run();
    verdict.samples = std::int64_t(track.size());
    verdict.sentence = sentence_of(verdict);
    return verdict;
  }

 private:
  ClearanceMeter meter_;
  double reach_m_;
  double tolerance_m_;
};

FlightCheck::FlightCheck(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
FlightCheck::FlightCheck(FlightCheck&&) noexcept = default;
FlightCheck& FlightCheck::operator=(FlightCheck&&) noexcept = default;
FlightCheck::~FlightCheck() = default;

Result<FlightCheck> FlightCheck::open(const std::filesystem::path& map_file, const Body& body,
                                      const Options& options) {
  auto tree = read_octomap(map_file);
  if (!tree) return tree.error();
  return from_tree(std::move(*tree), body, options);
}

Result<FlightCheck> FlightCheck::from_tree(std::unique_ptr<octomap::OcTree> tree, const Body& body,
                                           const Options& options) {
  if (auto status = body.check(); !status) return status.error();
  if (auto status = check_options(options); !status) return status.error();
  if (tree == nullptr || tree->getRoot() == nullptr) {
    return fail(ErrorCode::map_empty, "the map holds no voxel: create the map again");
  }
  if (options.count_unknown_as_obstacle) occupy_unknown(*tree);
  // FCL skips an inner node that does not know what its children hold.
  tree->updateInnerOccupancy();
  return FlightCheck(std::make_unique<Implementation>(ClearanceMeter(std::move(tree), body),
                                                      body.reach_m(), options.tolerance_m));
}

Result<FlightCheck> FlightCheck::from_solids(std::span<const Solid> solids, const Body& body,
                                             const Options& options) {
  if (auto status = body.check(); !status) return status.error();
  if (auto status = check_options(options); !status) return status.error();
  if (solids.empty()) {
    return fail(ErrorCode::map_empty, "the world has no solid: there is nothing to judge against");
  }
  for (const Solid& solid : solids) {
    if (auto status = solid.check(); !status) return status.error();
  }
  return FlightCheck(std::make_unique<Implementation>(ClearanceMeter(solids, body), body.reach_m(),
                                                      options.tolerance_m));
}

Result<FlightCheck> FlightCheck::from_payload(std::string_view payload, double resolution_m,
                                              const Body& body, const Options& options) {
  auto tree = read_payload(payload, resolution_m);
  if (!tree) return tree.error();
  return from_tree(std::move(*tree), body, options);
}

Result<Verdict> FlightCheck::judge(std::span<const Sample> track, double below_m) const {
  if (auto status = check_track(track); !status) return status.error();
  return implementation_->judge(track, below_m);
}

}  // namespace goshawk::flight_check
