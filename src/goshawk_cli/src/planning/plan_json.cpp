#include "planning/plan_json.hpp"

namespace goshawk::cli {
namespace {

Json stages_json(const std::vector<StageTime>& stages) {
  Json array = Json::array();
  for (const auto& stage : stages) {
    array.push_back({{"name", stage.name},
                     {"implementation", stage.implementation},
                     {"compute_us", stage.compute_us}});
  }
  return array;
}

Json path_json(const path_search::PlannedPath& path) {
  return {{"raw_length_m", path.raw_length_m},
          {"pruned_length_m", path.pruned_length_m},
          {"waypoints_raw", path.raw_map.size()},
          {"waypoints", path.waypoints_map.size()},
          {"expanded", path.counters.expanded},
          {"points", to_json(path.waypoints_map)},
          {"cost", path.cost},
          {"goal", path.goal},
          {"start_moved_m", path.start_moved_m},
          {"goal_moved_m", path.goal_moved_m},
          {"cut_off", path.cut_off},
          {"note", path.note()}};
}

Json polytope_json(const Polytope& p) {
  Json A = Json::array();
  Json b = Json::array();
  for (const HalfSpace& face : p.half_spaces) {
    A.push_back(to_json(face.normal));
    b.push_back(face.offset_m);
  }
  return {{"A", A}, {"b", b}, {"valid_from_s", p.valid_from_s}, {"valid_until_s", p.valid_until_s}};
}

Json corridor_json(const Corridor& corridor) {
  Json polytopes = Json::array();
  for (const auto& polytope : corridor.polytopes) polytopes.push_back(polytope_json(polytope));
  return {{"polytopes", polytopes},
          {"min_overlap_radius_m", to_json(corridor.min_overlap_radius_m())}};
}

Json trajectory_json(const Trajectory& trajectory) {
  const double duration_s = trajectory.duration_s();
  const double length_m = trajectory.length_m();
  const auto peaks = trajectory.peaks();
  Json pieces = Json::array();
  for (const auto& piece : trajectory.pieces) {
    Json points = Json::array();
    for (int j = 0; j < 6; ++j) points.push_back(to_json(Vec3(piece.control_points.col(j))));
    pieces.push_back({{"duration_s", piece.duration_s},
                      {"polytope", piece.polytope},
                      {"control_points", points}});
  }
  return {{"duration_s", duration_s},
          {"length_m", length_m},
          {"mean_speed_m_s", length_m / duration_s},
          {"max_speed_m_s", peaks.speed_m_s},
          {"max_acceleration_m_s2", peaks.acceleration_m_s2},
          {"pieces", pieces}};
}

Json state_json(const FlatState& state) {
  return {{"position", to_json(state.position)},
          {"velocity", to_json(state.velocity)},
          {"acceleration", to_json(state.acceleration)}};
}

Json request_json(const Plan& plan) {
  const Limits& l = plan.request.limits;
  return {{"start", state_json(plan.request.start)},
          {"goal", state_json(plan.request.goal)},
          {"limits",
           {{"v_max_m_s", l.v_max_m_s},
            {"a_max_m_s2", l.a_max_m_s2},
            {"norm", int(l.norm)},
            {"j_max_m_s3", l.j_max_m_s3},
            {"v_max_vertical_m_s", l.v_max_vertical_m_s},
            {"a_max_vertical_m_s2", l.a_max_vertical_m_s2}}}};
}

}  // namespace

Json certificate_to_json(const Certificate& c) {
  return {{"position_m", to_json(c.position_m)},
          {"validity_s", to_json(c.validity_s)},
          {"velocity_m_s", to_json(c.velocity_m_s)},
          {"acceleration_m_s2", to_json(c.acceleration_m_s2)},
          {"continuity_position_m", to_json(c.continuity_position_m)},
          {"continuity_velocity_m_s", to_json(c.continuity_velocity_m_s)},
          {"continuity_acceleration_m_s2", to_json(c.continuity_acceleration_m_s2)},
          {"start_m", to_json(c.start_m)},
          {"goal_m", to_json(c.goal_m)},
          {"jerk_m_s3", to_json(c.jerk_m_s3)},
          {"start_excess_m_s", to_json(c.start_excess_m_s)},
          {"start_excess_m_s2", to_json(c.start_excess_m_s2)},
          {"start_excess_s", to_json(c.start_excess_s)}};
}

Json plan_to_json(const Plan& plan) {
  const bool ok = plan.outcome.ok();
  Json object{{"ok", ok},
              {"code", std::string(to_string(plan.outcome.code()))},
              {"message", ok ? "" : plan.outcome.error().message},
              {"stages", stages_json(plan.stages)}};
  object["request"] = request_json(plan);
  object["path"] = plan.path ? path_json(*plan.path) : Json(nullptr);
  object["corridor"] = plan.corridor ? corridor_json(*plan.corridor) : Json(nullptr);
  object["trajectory"] = plan.solution ? trajectory_json(plan.solution->trajectory()) : Json(nullptr);
  object["certificate"] =
      plan.solution ? certificate_to_json(plan.solution->certified.certificate()) : Json(nullptr);
  return object;
}

}  // namespace goshawk::cli
