#include "switching.hpp"

#include <algorithm>
#include <cmath>

#include "cut.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kLook = 0.125;     // of a longest piece: how closely the curve is looked at
constexpr int kMostLooks = 40;      // along the curve, from a switch
constexpr double kLeastStay = 0.1;  // of a longest piece, for a polytope

/// The trajectory of a plan, by time.
class Curve {
 public:
  explicit Curve(const Plan& plan) {
    begins_s_.push_back(0.0);
    for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
      pieces_.push_back(plan.piece(k));
      begins_s_.push_back(begins_s_.back() + plan.durations_s[k]);
    }
  }

  double duration_s() const { return begins_s_.back(); }
  FlatState at(double t_s) const {
    const auto after = std::upper_bound(begins_s_.begin() + 1, begins_s_.end() - 1, t_s);
    const auto k = std::size_t(after - begins_s_.begin()) - 1;
    return pieces_[k].sample(std::clamp(t_s - begins_s_[k], 0.0, pieces_[k].duration_s));
  }

 private:
  std::vector<BezierPiece> pieces_;
  std::vector<double> begins_s_;
};

/// How far from `from_s`, in steps, the flight stays in a polytope.
double reach_s(const Curve& curve, const Polytope& polytope, double from_s, double step_s,
               double beyond_m) {
  double t = from_s;
  for (int i = 0; i < kMostLooks; ++i) {
    const double next = t + step_s;
    if (next <= 0.0 || next >= curve.duration_s()) break;
    if (!(polytope.violation(curve.at(next).position) <= beyond_m)) break;
    t = next;
  }
  return t;
}

}  // namespace

double move_switches(const PlanRequest& request, const Corridor& corridor, const Config& config,
                     std::span<const double> slopes, double beyond_m, Plan& plan) {
  const auto& polytopes = corridor.polytopes;
  const std::size_t n = polytopes.size();
  const Curve curve(plan);
  const double total_s = curve.duration_s();
  const Cutter cutter = Cutter::of(request, config, total_s, plan.at_moving_end);
  // What a moment in each polytope costs: seconds of flight a second.
  std::vector<double> switches_s(n + 1, 0.0), worth(n, 0.0);
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    const auto home = std::size_t(plan.polytopes[k]);
    switches_s[home + 1] += plan.durations_s[k];
    worth[home] += 0.5 * slopes[k] * total_s;
  }
  for (std::size_t k = 0; k < n; ++k) {
    worth[k] /= switches_s[k + 1];
    switches_s[k + 1] += switches_s[k];
  }
  double gain_s = 0.0;
  for (std::size_t k = 1; k < n; ++k) {
    const double gain = worth[k - 1] - worth[k];  // of an earlier switch
    const double step_s = (gain > 0.0 ? -kLook : kLook) * cutter.longest_s;
    const Polytope& other = polytopes[gain > 0.0 ? k : k - 1];
    const double way_s = reach_s(curve, other, switches_s[k], step_s, beyond_m) - switches_s[k];
    const double move_s = std::min(1.0, std::abs(gain)) * way_s;
    switches_s[k] += move_s;
    gain_s += std::abs(gain * move_s);
  }
  const double least_s = std::min(kLeastStay * cutter.longest_s, 0.5 * total_s / double(n));
  for (std::size_t k = 1; k < n; ++k) {
    switches_s[k] = std::max(switches_s[k], switches_s[k - 1] + least_s);
  }
  switches_s[n] = total_s;
  for (std::size_t k = n - 1; k > 0; --k) {
    switches_s[k] = std::min(switches_s[k], switches_s[k + 1] - least_s);
  }
  plan.durations_s.clear();
  plan.polytopes.clear();
  plan.knots.resize(1);
  for (std::size_t k = 0; k < n; ++k) {
    cutter.cut(switches_s[k], switches_s[k + 1] - switches_s[k], [&](double t_s, double piece_s) {
      append(plan, piece_s, int(k), curve.at(switches_s[k] + t_s));
    });
  }
  plan.knots.back() = request.goal;
  return gain_s / total_s;
}

}  // namespace goshawk::trajectory_optimizer
