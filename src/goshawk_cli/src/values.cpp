#include "values.hpp"

#include <fmt/format.h>

#include <charconv>

namespace goshawk::cli {
namespace {

std::optional<Vec3> parse_point(const std::string& text) {
  Vec3 point;
  const char* at = text.data();
  const char* end = at + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    const auto [stop, error] = std::from_chars(at, end, point[axis]);
    const bool last = axis == 2;
    if (error != std::errc{} || (last ? stop != end : stop == end || *stop != ',')) return {};
    at = stop + 1;
  }
  return point;
}

// Hands each point to `take`.
template <typename Take>
CLI::Option* add(const Verb& verb, const std::string& name, const std::string& what, Take take) {
  const auto parse = [name, take](const CLI::results_t& texts) {
    for (const auto& text : texts) {
      const auto point = parse_point(text);
      if (!point) {
        throw CLI::ValidationError(
            name, fmt::format("'{}' is not a point: write x,y,z in metres, as in 3,0,1", text));
      }
      take(*point);
    }
    return true;
  };
  return verb->add_option(name, parse, what)->type_name("X,Y,Z");
}

}  // namespace

CLI::Option* add_point(const Verb& verb, const std::string& name, Vec3& value,
                       const std::string& what) {
  auto* option = add(verb, name, what, [&value](const Vec3& point) { value = point; });
  return option->default_str(fmt::format("{:g},{:g},{:g}", value.x(), value.y(), value.z()));
}

CLI::Option* add_point(const Verb& verb, const std::string& name, std::optional<Vec3>& value,
                       const std::string& what) {
  return add(verb, name, what, [&value](const Vec3& point) { value = point; });
}

CLI::Option* add_points(const Verb& verb, const std::string& name, std::vector<Vec3>& values,
                        const std::string& what) {
  auto* option = add(verb, name, what, [&values](const Vec3& point) { values.push_back(point); });
  return option->expected(1, CLI::detail::expected_max_vector_size);
}

CLI::Validator not_negative() {
  const auto check = [](std::string& text) -> std::string {
    return text.starts_with('-') ? fmt::format("{} is below 0: give 0 or more", text) : "";
  };
  return {check, ""};
}

}  // namespace goshawk::cli
