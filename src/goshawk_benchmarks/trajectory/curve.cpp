#include "parts.hpp"

namespace goshawk::bench {
namespace {

using Json = nlohmann::ordered_json;

void add(Json& rows, double t, const char* what, const char* line, double value) {
  rows.push_back({{"t_s", t}, {"what", what}, {"line", line}, {"value", value}});
}

void draw(Report& report, const char* what, const char* label) {
  report.draw({.file = what,
               .title = std::string("One flight at density 0.4: ") + what,
               .x = "t_s",
               .y = "value",
               .x_label = "time [s]",
               .y_label = label,
               .series = "line",
               .where = {{"what", what}},
               .points_only = false,
               .from = "curve"});
}

}  // namespace

void record_curve(Report& report) {
  constexpr int kSteps = 100;
  const Task task = box_task(0.4, 1);
  const Flight flight = Planner::make("goshawk").value().fly(task);
  Json rows = Json::array();
  for (int i = 0; flight.solved && i <= kSteps; ++i) {
    const double t = flight.trajectory.duration_s() * i / kSteps;
    const FlatState s = flight.trajectory.sample(t);
    constexpr const char* kAxes[] = {"x", "y", "z"};
    for (int axis = 0; axis < 3; ++axis) {
      add(rows, t, "position", kAxes[axis], s.position[axis]);
      add(rows, t, "velocity", kAxes[axis], s.velocity[axis]);
      add(rows, t, "acceleration", kAxes[axis], s.acceleration[axis]);
    }
    add(rows, t, "velocity", "speed", s.velocity.norm());
    add(rows, t, "velocity", "limit", task.limits.v_max_m_s);
    add(rows, t, "acceleration", "size", s.acceleration.norm());
    add(rows, t, "acceleration", "limit", task.limits.a_max_m_s2);
  }
  report.note("curve", rows);
  draw(report, "position", "position [m]");
  draw(report, "velocity", "velocity [m/s]");
  draw(report, "acceleration", "acceleration [m/s^2]");
}

}  // namespace goshawk::bench
