#include "goshawk/flight_check/flight_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "clearance.hpp"
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
  return fail(ErrorCode::tracking_lost,
              "the track has a gap of " + std::to_string(longest_s) + " s at " +
                  std::to_string(at_s) +
                  " s, so it cannot be judged: what was flown there is not known; record it on a "
                  "machine that keeps up");
}

namespace {

constexpr double kFarthest_m = 1e6;

std::string sample_fault(const Sample& s, const Sample* previous) {
  if (!std::isfinite(s.t_s) || !s.position_map.allFinite() || !s.q_map_base.coeffs().allFinite()) {
    return "has a number that is not finite";
  }
  if (s.position_map.cwiseAbs().maxCoeff() > kFarthest_m) return "lies beyond 1e6 m";
  if (std::abs(s.q_map_base.norm() - 1.0) > 1e-3) return "has a quaternion without unit length";
  if (previous != nullptr && s.t_s < previous->t_s) return "goes back in time";
  return {};
}

Status check_track(std::span<const Sample> track) {
  if (track.empty()) {
    return fail(ErrorCode::invalid_input,
                "the flight has no sample to judge: record its odometry or sample its trajectory");
  }
  for (std::size_t i = 0; i < track.size(); ++i) {
    const std::string fault = sample_fault(track[i], i > 0 ? &track[i - 1] : nullptr);
    if (fault.empty()) continue;
    return fail(ErrorCode::invalid_input,
                "sample " + std::to_string(i) + " of the flight " + fault + ": mend the recording");
  }
  return success();
}

Status check_options(const Options& options) {
  if (options.tolerance_m >= 1e-5 && options.tolerance_m <= 1.0) return success();
  return fail(ErrorCode::invalid_parameter, "tolerance_m = " + std::to_string(options.tolerance_m) +
                                                " is outside of [1e-5, 1] m");
}

std::string sentence_of(const Verdict& v) {
  char text[256];
  const Vec3& p = v.clearance_place_map;
  if (v.touched) {
    std::snprintf(text, sizeof text, "touched an obstacle at %.3f s, near (%.3f, %.3f, %.3f)",
                  v.clearance_t_s, p.x(), p.y(), p.z());
  } else if (std::isinf(v.clearance_m)) {
    std::snprintf(text, sizeof text, "touched nothing: the map has no obstacle");
  } else {
    std::snprintf(text, sizeof text,
                  "touched nothing: smallest clearance %.3f m at %.3f s, from the obstacle at "
                  "(%.3f, %.3f, %.3f)",
                  v.clearance_m, v.clearance_t_s, p.x(), p.y(), p.z());
  }
  return text;
}

/// The straight, even motion between two samples.
class Span {
 public:
  Span(const Sample& from, const Sample& to, double reach_m) : from_(from), to_(to) {
    from_.q_map_base.normalize();
    to_.q_map_base.normalize();
    motion_m_ = (to_.position_map - from_.position_map).norm() +
                from_.q_map_base.angularDistance(to_.q_map_base) * reach_m;
  }

  /// [m] no point of the body moves farther than this over the whole span
  double motion_m() const { return motion_m_; }

  /// @param s in [0, 1]
  Pose pose(double s) const {
    return {from_.position_map + s * (to_.position_map - from_.position_map),
            from_.q_map_base.slerp(s, to_.q_map_base)};
  }
  double t_s(double s) const { return from_.t_s + s * (to_.t_s - from_.t_s); }

 private:
  Sample from_;
  Sample to_;
  double motion_m_ = 0.0;
};

/// Goes through a flight in the order of time and keeps the smallest clearance; stops at the
/// first contact.
class Judge {
 public:
  Judge(const ClearanceMeter& meter, double tolerance_m)
      : meter_(meter), tolerance_m_(tolerance_m) {}

  void begin(const Sample& first) {
    const Span here(first, first, 0.0);
    verdict_.clearance_t_s = first.t_s;
    verdict_.clearance_place_map = first.position_map;
    now_ = measure(here, 0.0, kInfinity);
    if (now_.distance_m <= 0.0) record_contact(here, {0.0, now_});
  }

  /// @pre begin() or go() came before, with the sample that the span starts from; not touched()
  void go(const Span& span) {
    const Moment start{0.0, now_};
    const Moment end{1.0, measure(span, 1.0, now_.distance_m + span.motion_m())};
    search(span, start, end);
    now_ = end.clearance;
  }

  bool touched() const { return verdict_.touched; }
  Verdict verdict() const { return verdict_; }

 private:
  struct Moment {
    double s;  // place in the span
    Clearance clearance;
    double distance_m() const { return clearance.distance_m; }
  };

  /// Finds the smallest clearance strictly between two moments, and counts the later one.
  void search(const Span& span, Moment a, Moment b) {
    const double motion_m = (b.s - a.s) * span.motion_m();
    const double in_between_m = (a.distance_m() + b.distance_m() - motion_m) / 2.0;
    if (b.distance_m() > 0.0 && in_between_m >= smallest_of_interest_m()) return;
    if (motion_m <= ClearanceMeter::kContact_m / 10.0) {
      if (b.distance_m() <= 0.0) record_contact(span, b);
      return;
    }
    const double s = (a.s + b.s) / 2.0;
    const Moment middle{s, measure(span, s, a.distance_m() + motion_m / 2.0)};
    search(span, a, middle);
    if (!touched()) search(span, middle, b);
  }

  /// [m] a bound that is not below this cannot change the verdict. Where the flight comes close,
  /// the tolerance shrinks with the clearance, so that contact or none is always decided.
  double smallest_of_interest_m() const {
    return verdict_.clearance_m - std::min(tolerance_m_, verdict_.clearance_m / 2.0);
  }

  Clearance measure(const Span& span, double s, double at_most_m) {
    const Pose pose = span.pose(s);
    const Clearance found = meter_.measure(pose, at_most_m);
    ++verdict_.queries;
    if (found.distance_m > 0.0 && found.distance_m < verdict_.clearance_m) {
      verdict_.clearance_m = found.distance_m;
      verdict_.clearance_t_s = span.t_s(s);
      verdict_.clearance_place_map = found.obstacle_map;
    }
    return found;
  }

  void record_contact(const Span& span, const Moment& moment) {
    verdict_.touched = true;
    verdict_.clearance_m = 0.0;
    verdict_.clearance_t_s = span.t_s(moment.s);
    verdict_.clearance_place_map = moment.clearance.obstacle_map;
  }

  const ClearanceMeter& meter_;
  double tolerance_m_;
  Clearance now_;  // at the last sample
  Verdict verdict_{.clearance_m = kInfinity};
};

}  // namespace

class FlightCheck::Implementation {
 public:
  Implementation(std::shared_ptr<const octomap::OcTree> tree, const Body& body,
                 const Options& options)
      : meter_(std::move(tree), body),
        reach_m_(body.reach_m()),
        tolerance_m_(options.tolerance_m) {}

  Verdict judge(std::span<const Sample> track) const {
    Judge judge(meter_, tolerance_m_);
    judge.begin(track.front());
    for (std::size_t i = 1; i < track.size() && !judge.touched(); ++i) {
      judge.go(Span(track[i - 1], track[i], reach_m_));
    }
    Verdict verdict = judge.verdict();
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
    return fail(ErrorCode::map_empty, "the map holds no voxel; make the map again");
  }
  if (options.count_unknown_as_obstacle) occupy_unknown(*tree);
  // FCL passes over an inner node that does not say what its children hold.
  tree->updateInnerOccupancy();
  return FlightCheck(std::make_unique<Implementation>(std::move(tree), body, options));
}

Result<FlightCheck> FlightCheck::from_payload(std::string_view payload, double resolution_m,
                                              const Body& body, const Options& options) {
  auto tree = read_payload(payload, resolution_m);
  if (!tree) return tree.error();
  return from_tree(std::move(*tree), body, options);
}

Result<Verdict> FlightCheck::judge(std::span<const Sample> track) const {
  if (auto status = check_track(track); !status) return status.error();
  return implementation_->judge(track);
}

}  // namespace goshawk::flight_check
