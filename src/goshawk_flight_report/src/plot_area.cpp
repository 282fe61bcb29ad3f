#include "plot_area.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace goshawk::flight_report {

namespace {

constexpr Color kGrid{0.0, 0.0, 0.0, 0.09};
constexpr Color kFrame{0.45, 0.47, 0.5};

std::string number(double value, double step) {
  const int digits = std::max(0, int(std::ceil(-std::log10(step) - 1e-9)));
  char text[48];
  // No "-0": it comes from the rounding of a tick next to zero.
  std::snprintf(text, sizeof text, "%.*f", digits, std::abs(value) < step / 2.0 ? 0.0 : value);
  return text;
}

/// Calls tick(value) for the multiples of step within the interval, at most a few hundred.
template <typename Tick>
void for_ticks(const Interval& interval, double step, Tick&& tick) {
  const double first = std::ceil(interval.lo / step - 1e-9);
  const int count = std::min(400, int(std::floor(interval.hi / step + 1e-9) - first) + 1);
  for (int k = 0; k < count; ++k) tick((first + k) * step);
}

}  // namespace

double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

void draw_axes(Canvas& canvas, const PlotArea& area, const Axes& axes) {
  const Rectangle& r = area.place;
  const double bottom = r.top + r.height;
  const double u_step = round_step(area.u.length() / r.width * axes.fewest_px);
  const double v_step = round_step(area.v.length() / r.height * axes.fewest_px * 0.6);
  for_ticks(area.u, u_step, [&](double u) {
    const double x = area.pixel(u, area.v.lo).x();
    canvas.polyline(std::array{Vec2(x, r.top), Vec2(x, bottom)}, {kGrid, 1.0});
    if (!axes.u_numbers) return;
    canvas.text({x, bottom + 13.0}, number(u, u_step), {.align = Align::center});
  });
  for_ticks(area.v, v_step, [&](double v) {
    const double y = area.pixel(area.u.lo, v).y();
    canvas.polyline(std::array{Vec2(r.left, y), Vec2(r.left + r.width, y)}, {kGrid, 1.0});
    canvas.text({r.left - 8.0, y}, number(v, v_step), {.align = Align::right});
  });
  canvas.rectangle(r, {0, 0, 0, 0}, {kFrame, 1.2});
  if (!axes.u_label.empty()) {
    canvas.text({r.left + r.width / 2.0, bottom + 35.0}, axes.u_label,
                {.size_px = 14.0, .align = Align::center});
  }
  canvas.text({r.left - 54.0, r.top + r.height / 2.0}, axes.v_label,
              {.size_px = 14.0, .align = Align::center, .upwards = true});
}

}  // namespace goshawk::flight_report
