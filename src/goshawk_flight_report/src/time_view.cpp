// The picture against time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "goshawk/flight_report/draw.hpp"
#include "plot.hpp"
#include "style.hpp"

namespace goshawk::flight_report {

namespace {

constexpr int kWidth_px = 1400;
constexpr double kLeft_px = 84.0, kTop_px = 66.0, kPanel_px = 200.0, kGap_px = 26.0;
constexpr double kLegend_px = 190.0, kBottom_px = 58.0;
constexpr int kPanels = 4;

constexpr std::array<Color, 3> kAxes{{{0.84, 0.37, 0.0}, {0.0, 0.62, 0.45}, {0.0, 0.45, 0.70}}};
constexpr Color kPlanned{0.16, 0.40, 0.70};
constexpr Stroke kAsPlanned{kPlanned, 2.0};
constexpr Stroke kAsFlown{kFlown, 1.2, 5.0};
constexpr Stroke kLimit{{0.80, 0.12, 0.12}, 1.4};
constexpr Stroke kLegBorder{{0.0, 0.0, 0.0, 0.25}, 1.0, 3.0};

struct Curve {
  std::string name;  // empty: not in the legend
  Stroke stroke;
  std::vector<Vec2> points;  // t [s], value
};

Interval time_span(const Flight& flight) {
  Interval span{1e300, -1e300};
  for (const FlownSample& s : flight.flown) span.include(s.t_s);
  for (const FollowedLeg& part : flight.followed()) {
    span.include(part.leg->start_t_s);
    span.include(part.leg->start_t_s + part.duration_s);
  }
  if (span.length() < 1e-6) span.hi = span.lo + 1.0;
  return span;
}

/// @param value of the planned state @return it at even times over the whole flight
std::vector<Vec2> of_planned(const Flight& flight, const Interval& span,
                             const std::function<double(const FlatState&)>& value) {
  constexpr int kSteps = 3000;
  std::vector<Vec2> points;
  for (int k = 0; k <= kSteps; ++k) {
    const double t_s = span.lo + span.length() * k / kSteps;
    if (const auto state = flight.planned_at(t_s)) points.emplace_back(t_s, value(*state));
  }
  return points;
}

std::vector<Vec2> of_flown(const Flight& flight,
                           const std::function<double(const FlownSample&)>& value) {
  std::vector<Vec2> points;
  for (const FlownSample& s : flight.flown) points.emplace_back(s.t_s, value(s));
  return points;
}

/// What a limit bounds.
double size_of(const Vec3& v, LimitNorm norm) {
  return norm == LimitNorm::euclidean ? v.norm() : v.cwiseAbs().maxCoeff();
}

/// Differences of the flown velocity over 0.1 s or so: shorter ones show noise only.
std::vector<Vec2> flown_acceleration(const Flight& flight) {
  constexpr double kOver_s = 0.1;
  std::vector<Vec2> points;
  std::size_t from = 0;
  for (const FlownSample& s : flight.flown) {
    while (flight.flown[from].t_s < s.t_s - kOver_s) ++from;
    const FlownSample& before = flight.flown[from];
    const double dt_s = s.t_s - before.t_s;
    if (dt_s < kOver_s / 2.0) continue;
    const Vec3 a = (s.velocity_map - before.velocity_map) / dt_s;
    points.emplace_back((s.t_s + before.t_s) / 2.0, size_of(a, flight.limits.norm));
  }
  return points;
}

std::vector<Vec2> tracking_error_mm(const Flight& flight) {
  std::vector<Vec2> points;
  for (const FlownSample& s : flight.flown) {
    const auto state = flight.planned_at(s.t_s);
    if (state) points.emplace_back(s.t_s, 1e3 * (s.position_map - state->position).norm());
  }
  return points;
}

/// Room for the curves and the limit; from zero if that does not squeeze them.
Interval values(const std::vector<Curve>& curves, std::optional<double> limit) {
  Interval v{1e300, -1e300};
  for (const Curve& curve : curves) {
    for (const Vec2& p : curve.points) v.include(p.y());
  }
  if (limit) v.include(*limit);
  if (v.lo > v.hi) v = {0.0, 1.0};
  if (v.lo >= 0.0 && (limit || v.lo < 0.5 * v.hi)) v.lo = 0.0;
  if (v.length() < 1e-9) v = {v.lo - 0.5, v.hi + 0.5};
  v.hi += 0.08 * v.length();
  if (v.lo != 0.0) v.lo -= 0.05 * v.length();
  return v;
}

class TimePicture {
 public:
  explicit TimePicture(const Flight& flight)
      : flight_(flight),
        span_(time_span(flight)),
        sheet_(kWidth_px,
               int(kTop_px + kPanels * kPanel_px + (kPanels - 1) * kGap_px + kBottom_px)) {
    sheet_.text({kLeft_px, 30.0}, flight.title, kTitle);
    panel("position [m]", positions(), std::nullopt);
    const LimitNorm norm = flight.limits.norm;
    const bool whole = norm == LimitNorm::euclidean;
    const auto speed = [norm](const FlatState& s) { return size_of(s.velocity, norm); };
    const auto flown_speed = [norm](const FlownSample& s) { return size_of(s.velocity_map, norm); };
    const auto acceleration = [norm](const FlatState& s) { return size_of(s.acceleration, norm); };
    panel(whole ? "speed [m/s]" : "fastest axis [m/s]",
          {{"planned", kAsPlanned, of_planned(flight, span_, speed)},
           {"flown", kAsFlown, of_flown(flight, flown_speed)}},
          flight.limits.v_max_m_s);
    panel(whole ? "acceleration [m/s\u00b2]" : "largest axis [m/s\u00b2]",
          {{"planned", kAsPlanned, of_planned(flight, span_, acceleration)},
           {"flown", kAsFlown, flown_acceleration(flight)}},
          flight.limits.a_max_m_s2);
    const auto errors_mm = tracking_error_mm(flight);
    Plot plot = panel("tracking error [mm]", {{"distance", {kPlanned, 1.6}, errors_mm}}, {});
    summarize(plot, errors_mm);
  }

  Status save(const std::filesystem::path& png) const { return sheet_.save(png); }

 private:
  std::vector<Curve> positions() const {
    std::vector<Curve> curves;
    for (int axis = 0; axis < 3; ++axis) {
      curves.push_back(
          {fmt::format("{} planned", "xyz"[axis]),
           {kAxes[std::size_t(axis)], 2.0},
           of_planned(flight_, span_, [axis](const FlatState& s) { return s.position[axis]; })});
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto position = [axis](const FlownSample& s) { return s.position_map[axis]; };
      curves.push_back({axis == 0 ? "flown" : "", kAsFlown, of_flown(flight_, position)});
    }
    return curves;
  }

  Plot panel(const std::string& label, const std::vector<Curve>& curves,
             std::optional<double> limit) {
    const double top = kTop_px + drawn_ * (kPanel_px + kGap_px);
    const bool last = ++drawn_ == kPanels;
    Plot plot(sheet_, {kLeft_px, top}, {kWidth_px - kLeft_px - kLegend_px, kPanel_px}, span_,
              values(curves, limit));
    plot.axes(last ? "time [s]" : "", label);
    for (const Leg* leg : kept_) {
      if (leg->trajectory.pieces.empty()) continue;
      for (const double t_s : {leg->start_t_s, leg->start_t_s + leg->trajectory.duration_s()}) {
        plot.line({{t_s, plot.v().lo}, {t_s, plot.v().hi}}, kLegBorder);
      }
    }
    if (limit) plot.line({{span_.lo, *limit}, {span_.hi, *limit}}, kLimit);
    for (const Curve& curve : curves) {
      plot.line(curve.points, curve.stroke);
      if (!curve.name.empty() && curve.points.size() > 1) {
        plot.explain_line(curve.name, curve.stroke);
      }
    }
    if (limit) plot.explain_line(fmt::format("limit {:.4g}", *limit), kLimit);
    return plot;
  }

  static void summarize(Plot& plot, const std::vector<Vec2>& errors_mm) {
    if (errors_mm.empty()) return plot.note("nothing to compare");
    double squares = 0.0, largest = 0.0;
    for (const Vec2& p : errors_mm) {
      squares += p.y() * p.y();
      largest = std::max(largest, p.y());
    }
    plot.note(fmt::format("rms {:.1f} mm", std::sqrt(squares / double(errors_mm.size()))));
    plot.note(fmt::format("largest {:.1f} mm", largest));
  }

  const Flight& flight_;
  std::vector<const Leg*> kept_ = flight_.kept_legs();
  Interval span_;
  Sheet sheet_;
  int drawn_ = 0;
};

}  // namespace

Status draw_time(const Flight& flight, const std::filesystem::path& png) {
  if (auto status = flight.check(); !status) return status;
  const bool timed = !flight.flown.empty() || std::ranges::any_of(flight.legs, [](const Leg& leg) {
    return !leg.trajectory.pieces.empty();
  });
  if (timed) return TimePicture(flight).save(png);
  return fail(ErrorCode::invalid_input,
              "the flight has neither a trajectory nor a flown track to draw against time");
}

}  // namespace goshawk::flight_report
