// The picture against time.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>

#include "canvas.hpp"
#include "goshawk/flight_report/draw.hpp"
#include "plot_area.hpp"

namespace goshawk::flight_report {

namespace {

constexpr int kWidth_px = 1400;
constexpr double kLeft_px = 84.0, kTop_px = 66.0, kPanel_px = 200.0, kGap_px = 26.0;
constexpr double kLegend_px = 190.0, kBottom_px = 58.0;
constexpr int kPanels = 4;

constexpr std::array<Color, 3> kAxes{{{0.84, 0.37, 0.0}, {0.0, 0.62, 0.45}, {0.0, 0.45, 0.70}}};
constexpr Color kPlanned{0.16, 0.40, 0.70};
constexpr Color kFlown{0.05, 0.05, 0.05};
constexpr Color kLimit{0.80, 0.12, 0.12};
constexpr Color kJoint{0.0, 0.0, 0.0, 0.25};

struct Curve {
  std::string name;
  Stroke stroke;
  std::vector<Vec2> points;  // t [s], value
};

/// Planned states at even times over the whole flight, on the flight's clock.
struct Timed {
  double t_s;
  FlatState state;
};

Interval time_span(const Flight& flight) {
  Interval span{1e300, -1e300};
  for (const FlownSample& s : flight.flown) span.include(s.t_s);
  for (const Leg& leg : flight.legs) {
    if (leg.trajectory.pieces.empty()) continue;
    span.include(leg.start_t_s);
    span.include(leg.start_t_s + leg.trajectory.duration_s());
  }
  if (span.length() < 1e-6) span.hi = span.lo + 1.0;
  return span;
}

std::vector<Timed> planned(const Flight& flight, const Interval& span) {
  constexpr int kSteps = 3000;
  std::vector<Timed> states;
  for (int k = 0; k <= kSteps; ++k) {
    const double t_s = span.lo + span.length() * k / kSteps;
    if (const auto state = flight.planned_at(t_s)) states.push_back({t_s, *state});
  }
  return states;
}

/// What a limit bounds.
double size_of(const Vec3& v, LimitNorm norm) {
  return norm == LimitNorm::euclidean ? v.norm() : v.cwiseAbs().maxCoeff();
}

std::vector<Vec2> of_planned(const std::vector<Timed>& states,
                             const std::function<double(const FlatState&)>& value) {
  std::vector<Vec2> points;
  for (const Timed& s : states) points.emplace_back(s.t_s, value(s.state));
  return points;
}

std::vector<Vec2> of_flown(const Flight& flight,
                           const std::function<double(const FlownSample&)>& value) {
  std::vector<Vec2> points;
  for (const FlownSample& s : flight.flown) points.emplace_back(s.t_s, value(s));
  return points;
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

class TimePicture {
 public:
  explicit TimePicture(const Flight& flight)
      : flight_(flight),
        span_(time_span(flight)),
        canvas_(kWidth_px,
                int(kTop_px + kPanels * kPanel_px + (kPanels - 1) * kGap_px + kBottom_px)) {}

  Status draw(const std::filesystem::path& png) {
    const auto states = planned(flight_, span_);
    canvas_.text({kLeft_px, 30.0}, flight_.title,
                 {.size_px = 20.0, .color = {0.1, 0.1, 0.12}, .bold = true});
    panel("position [m]", positions(states), std::nullopt);
    const LimitNorm norm = flight_.limits.norm;
    const bool whole = norm == LimitNorm::euclidean;
    panel(whole ? "speed [m/s]" : "fastest axis [m/s]",
          {{"planned",
            {kPlanned, 2.0},
            of_planned(states, [norm](const FlatState& s) { return size_of(s.velocity, norm); })},
           {"flown",
            {kFlown, 1.2, 5.0},
            of_flown(flight_,
                     [norm](const FlownSample& s) { return size_of(s.velocity_map, norm); })}},
          flight_.limits.v_max_m_s);
    panel(
        whole ? "acceleration [m/s\u00b2]" : "largest axis [m/s\u00b2]",
        {{"planned",
          {kPlanned, 2.0},
          of_planned(states, [norm](const FlatState& s) { return size_of(s.acceleration, norm); })},
         {"flown", {kFlown, 1.2, 5.0}, flown_acceleration(flight_)}},
        flight_.limits.a_max_m_s2);
    panel("tracking error [mm]", {{"distance", {kPlanned, 1.6}, tracking_error_mm(flight_)}},
          std::nullopt);
    return canvas_.save(png);
  }

 private:
  std::vector<Curve> positions(const std::vector<Timed>& states) const {
    std::vector<Curve> curves;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      const Color& color = kAxes[std::size_t(axis)];
      curves.push_back(
          {name + " planned", {color, 2.0}, of_planned(states, [axis](const FlatState& s) {
             return s.position[axis];
           })});
    }
    for (int axis = 0; axis < 3; ++axis) {
      curves.push_back(
          {axis == 0 ? "flown" : "",
           {kFlown, 1.2, 5.0},
           of_flown(flight_, [axis](const FlownSample& s) { return s.position_map[axis]; })});
    }
    return curves;
  }

  PlotArea area_for(const std::vector<Curve>& curves, std::optional<double> limit) const {
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
    const double top = kTop_px + drawn_ * (kPanel_px + kGap_px);
    return {{kLeft_px, top, kWidth_px - kLeft_px - kLegend_px, kPanel_px}, span_, v};
  }

  void panel(const std::string& label, const std::vector<Curve>& curves,
             std::optional<double> limit) {
    const PlotArea area = area_for(curves, limit);
    const bool last = ++drawn_ == kPanels;
    draw_axes(canvas_, area, {last ? "time [s]" : "", label, last});
    canvas_.clip(area.place);
    for (const Leg& leg : flight_.legs) {
      if (leg.trajectory.pieces.empty()) continue;
      vertical(area, leg.start_t_s);
      vertical(area, leg.start_t_s + leg.trajectory.duration_s());
    }
    if (limit) horizontal(area, *limit);
    for (const Curve& curve : curves) {
      std::vector<Vec2> line;
      for (const Vec2& p : curve.points) line.push_back(area.pixel(p.x(), p.y()));
      canvas_.polyline(line, curve.stroke);
    }
    canvas_.unclip();
    legend(area, curves, limit);
  }

  void vertical(const PlotArea& area, double t_s) {
    canvas_.polyline(std::array{area.pixel(t_s, area.v.lo), area.pixel(t_s, area.v.hi)},
                     {kJoint, 1.0, 3.0});
  }
  void horizontal(const PlotArea& area, double value) {
    canvas_.polyline(std::array{area.pixel(area.u.lo, value), area.pixel(area.u.hi, value)},
                     {kLimit, 1.4});
  }

  void legend(const PlotArea& area, const std::vector<Curve>& curves, std::optional<double> limit) {
    const double x = area.place.left + area.place.width + 16.0;
    double y = area.place.top + 12.0;
    const auto entry = [&](const std::string& name, const Stroke& stroke) {
      canvas_.polyline(std::array{Vec2(x, y), Vec2(x + 28.0, y)}, stroke);
      canvas_.text({x + 36.0, y}, name, {});
      y += 22.0;
    };
    for (const Curve& curve : curves) {
      if (!curve.name.empty() && curve.points.size() > 1) entry(curve.name, curve.stroke);
    }
    if (limit) {
      char text[40];
      std::snprintf(text, sizeof text, "limit %.4g", *limit);
      entry(text, {kLimit, 1.4});
    } else if (drawn_ == kPanels) {
      error_summary(curves.front().points, {x, y + 4.0});
    }
  }

  void error_summary(const std::vector<Vec2>& errors_mm, const Vec2& at) {
    if (errors_mm.empty()) {
      canvas_.text(at, "nothing to compare", {});
      return;
    }
    double squares = 0.0, largest = 0.0;
    for (const Vec2& p : errors_mm) {
      squares += p.y() * p.y();
      largest = std::max(largest, p.y());
    }
    char text[64];
    std::snprintf(text, sizeof text, "rms %.1f mm", std::sqrt(squares / double(errors_mm.size())));
    canvas_.text(at, text, {});
    std::snprintf(text, sizeof text, "largest %.1f mm", largest);
    canvas_.text(at + Vec2(0.0, 22.0), text, {});
  }

  const Flight& flight_;
  Interval span_;
  Canvas canvas_;
  int drawn_ = 0;
};

}  // namespace

Status draw_time(const Flight& flight, const std::filesystem::path& png) {
  if (auto status = flight.check(); !status) return status;
  bool timed = !flight.flown.empty();
  for (const Leg& leg : flight.legs) timed = timed || !leg.trajectory.pieces.empty();
  if (timed) return TimePicture(flight).draw(png);
  return fail(ErrorCode::invalid_input,
              "the flight has neither a trajectory nor a flown track to draw against time");
}

}  // namespace goshawk::flight_report
