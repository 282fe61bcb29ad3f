#include "planning/map_options.hpp"

namespace goshawk::cli {

runtime::RosArgs MapOptions::ros_args() const {
  runtime::RosArgs args;
  args.params_files = params_files;
  const auto set = [&](const char* name, const std::string& value) {
    if (!value.empty()) args.overrides.push_back({"map_server", name, value});
  };
  set("map_file", map);
  set("unknown", unknown);
  set("radius_m", radius);
  set("margin_m", margin);
  set("resolution_m", resolution);
  return args;
}

Limits MapOptions::limits() const {
  Limits limits;
  limits.v_max_m_s = v_max_m_s.value_or(limits.v_max_m_s);
  limits.a_max_m_s2 = a_max_m_s2.value_or(limits.a_max_m_s2);
  limits.v_max_vertical_m_s = v_max_vertical_m_s.value_or(limits.v_max_vertical_m_s);
  limits.a_max_vertical_m_s2 = a_max_vertical_m_s2.value_or(limits.a_max_vertical_m_s2);
  limits.j_max_m_s3 = j_max_m_s3.value_or(limits.j_max_m_s3);
  if (const auto known = from_word<LimitNorm>(norm)) limits.norm = *known;
  return limits;
}

}  // namespace goshawk::cli
