#include "cases.hpp"

#include <cmath>
#include <limits>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/corridor_builder/config.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/path_search/config.hpp"
#include "goshawk/path_search/path_search.hpp"

namespace goshawk::conformance {
namespace {

msg::PlanRequest request_between(const Vec3& start, const Vec3& goal) {
  PlanRequest request;
  request.id = 1;
  request.start.position = start;
  request.goal.position = goal;
  request.goal_yaw_rad = 0.7;
  request.limits = {.v_max_m_s = 2.0, .a_max_m_s2 = 2.0};
  return conversions::to_msg(request);
}

/// Faults of a request, the same for every stage that gets it.
template <typename Input>
void add_bad_requests(Cases<Input>& cases, const Input& good) {
  const auto add = [&](const char* name, std::set<std::string> codes, auto&& change) {
    Case<Input> bad{name, good, std::move(codes)};
    change(request_of(bad.input));
    cases.bad.push_back(std::move(bad));
  };
  add("a request in another frame", {"wrong_frame"},
      [](auto& r) { r.header().frame_id("base_link"); });
  add("a start that is not a number", {"invalid_input"},
      [](auto& r) { r.start().position().x(kNan); });
  add("a goal at infinity", {"invalid_input"},
      [](auto& r) { r.goal().position().y(std::numeric_limits<double>::infinity()); });
  add("a speed limit below zero", {"invalid_limits"}, [](auto& r) { r.limits().v_max(-1.0); });
  add("an acceleration limit of zero", {"invalid_limits"}, [](auto& r) { r.limits().a_max(0.0); });
  add("a norm of limits that does not exist", {"invalid_limits", "invalid_input"},
      [](auto& r) { r.limits().norm(9); });
  add("a rule for unknown space that does not exist", {"invalid_input"},
      [](auto& r) { r.unknown(9); });
  add("a start that looks nowhere", {"invalid_input"}, [](auto& r) { r.start_yaw(kNan); });
  add("a deadline that has passed", {"deadline_exceeded"}, [](auto& r) {
    r.deadline(1e-9);  // it has passed by the time that a stage can look
  });
}

path_search::PathSearch make_search(const World& world) {
  auto search = path_search::PathSearch::create({});
  search->set_map(world.grid);
  return *std::move(search);
}

/// Good paths, as any search stage might send.
std::vector<msg::Path> make_paths(const World& world, Random& random, int count) {
  auto search = make_search(world);
  std::vector<msg::Path> paths;
  while (int(paths.size()) < count) {
    const Vec3 start = free_point(world, random);
    const Vec3 goal = free_point(world, random);
    const auto found = search.plan(start, goal);
    if (!found || (goal - start).norm() < 1.0) continue;
    msg::Path path;
    path.header(conversions::make_header(1));
    path.request(request_between(start, goal));
    path.implementation("conformance");
    path.map_version(world.grid->version);
    path.raw(conversions::to_points(found->raw_map));
    path.waypoints(conversions::to_points(found->waypoints_map));
    path.length(found->pruned_length_m);
    paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace

Cases<msg::PlanRequest> search_cases(const World& world, Random& random, int count) {
  Cases<msg::PlanRequest> cases{.good = {}, .bad = {}, .no_map = "no_map"};
  for (auto& path : make_paths(world, random, count))
    cases.good.push_back({"", path.request(), {}});
  const msg::PlanRequest good = cases.good.front().input;
  add_bad_requests(cases, good);
  const auto add = [&](const char* name, const char* code, const Vec3& start, const Vec3& goal) {
    cases.bad.push_back({name, request_between(start, goal), {code}});
  };
  const Vec3 free = free_point(world, random);
  add("a start in an obstacle", "start_occupied", world.in_obstacle_map, free);
  add("a goal in an obstacle", "goal_occupied", free, world.in_obstacle_map);
  add("a start outside the map", "start_outside", world.outside_map, free);
  add("a goal outside the map", "goal_outside", free, world.outside_map);
  add("a goal that is cut off", "no_path", free, world.in_room_map);
  return cases;
}

Cases<msg::Path> corridor_cases(const World& world, Random& random, int count) {
  Cases<msg::Path> cases{.good = {}, .bad = {}, .no_map = "no_map"};
  for (auto& path : make_paths(world, random, count)) cases.good.push_back({"", path, {}});
  const msg::Path good = cases.good.front().input;
  add_bad_requests(cases, good);
  const auto add = [&](const char* name, std::set<std::string> codes, auto&& change) {
    Case<msg::Path> bad{name, good, std::move(codes)};
    change(bad.input);
    cases.bad.push_back(std::move(bad));
  };
  add("a path in another frame", {"wrong_frame"}, [](auto& p) { p.header().frame_id("odom"); });
  add("a path of one point", {"invalid_input"}, [](auto& p) { p.waypoints().resize(1); });
  add("a path of no points", {"invalid_input"}, [](auto& p) { p.waypoints().clear(); });
  add("a waypoint that is not a number", {"invalid_input"},
      [](auto& p) { p.waypoints().back().z(kNan); });
  add("a path through a wall", {"segment_blocked"}, [&](auto& p) {
    p.waypoints(conversions::to_points({world.in_room_map, free_point(world, random)}));
  });
  add("a path of a newer map", {"no_map"}, [](auto& p) { p.map_version(1'000'000); });
  return cases;
}

Cases<msg::Corridor> trajectory_cases(const World& world, Random& random, int count) {
  Cases<msg::Corridor> cases;
  auto builder = corridor_builder::CorridorBuilder::create({});
  for (auto& path : make_paths(world, random, count)) {
    const auto built = builder->build(*world.grid, conversions::from_msg(path.waypoints()));
    if (!built) continue;
    msg::Corridor corridor;
    corridor.header(conversions::make_header(1));
    corridor.request(path.request());
    corridor.implementation("conformance");
    corridor.map_version(world.grid->version);
    corridor.waypoints(conversions::to_points(built->waypoints_map));
    corridor.polytopes(conversions::to_msg(built->polytopes));
    corridor.min_overlap_radius(built->min_overlap_radius_m());
    cases.good.push_back({"", std::move(corridor), {}});
  }
  const msg::Corridor good = cases.good.front().input;
  add_bad_requests(cases, good);
  const auto add = [&](const char* name, std::set<std::string> codes, auto&& change) {
    Case<msg::Corridor> bad{name, good, std::move(codes)};
    change(bad.input);
    cases.bad.push_back(std::move(bad));
  };
  add("a corridor in another frame", {"wrong_frame"}, [](auto& c) { c.header().frame_id("odom"); });
  add("a corridor of no polytopes", {"invalid_input"}, [](auto& c) { c.polytopes().clear(); });
  add("a polytope whose sizes disagree", {"invalid_input"},
      [](auto& c) { c.polytopes().front().normals().pop_back(); });
  add("a polytope that is not a number", {"invalid_input"},
      [](auto& c) { c.polytopes().front().offsets().front() = kNan; });
  add("a start faster than the limits", {"start_infeasible", "trajectory_infeasible"},
      [](auto& c) { c.request().start().velocity().x(50.0); });
  add("a start outside the corridor", {"start_infeasible", "invalid_input"},
      [](auto& c) { c.request().start().position().x(500.0); });
  return cases;
}

}  // namespace goshawk::conformance
