#include "cli.hpp"

#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace goshawk::cli {

std::optional<int> parse(CLI::App& app, Arguments arguments) {
  const bool json = std::ranges::find(arguments, "--json") != arguments.end();
  std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the back
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    if (json && error.get_exit_code() != 0) {
      const bool value = dynamic_cast<const CLI::ValidationError*>(&error) != nullptr ||
                         dynamic_cast<const CLI::ConversionError*>(&error) != nullptr;
      const auto code = value ? ErrorCode::invalid_parameter : ErrorCode::invalid_input;
      return report_failure(fail(code, error.what()), true, kWrongCall);
    }
    return app.exit(error) == 0 ? kDone : kWrongCall;
  }
  return {};
}

CLI::Validator not_negative() {
  const auto check = [](std::string& text) -> std::string {
    return text.starts_with('-') ? text + " is below 0: give 0 or more" : "";
  };
  return {check, ""};
}

Result<Vec3> parse_point(const std::string& text) {
  Vec3 point;
  const char* at = text.data();
  const char* end = at + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    const auto [stop, error] = std::from_chars(at, end, point[axis]);
    const bool last = axis == 2;
    if (error != std::errc{} || (last ? stop != end : stop == end || *stop != ',')) {
      return fail(ErrorCode::invalid_parameter,
                  "'" + text + "' is not a point: write x,y,z in metres, as in 3,0,1");
    }
    at = stop + 1;
  }
  return point;
}

void print_json(const Json& object) {
  std::printf("%s\n", object.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

int report_failure(const Error& error, bool json, int status) {
  const std::string code(to_string(error.code));
  if (json) {
    print_json({{"ok", false}, {"code", code}, {"message", error.message}});
  } else {
    std::fprintf(stderr, "goshawk: %s: %s\n", code.c_str(), error.message.c_str());
  }
  return status;
}

Json to_json(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

int become(const Arguments& command) {
  std::vector<char*> pointers;
  for (const auto& word : command) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  execv(pointers[0], pointers.data());
  return report_failure(
      fail(ErrorCode::io_failed, command[0] + " cannot be started: " + std::strerror(errno)), false,
      kNotDone);
}

Json to_json(const Vec3& v) {
  return Json::array({to_json(v.x()), to_json(v.y()), to_json(v.z())});
}

Json to_json(const std::vector<Vec3>& points) {
  Json array = Json::array();
  for (const auto& p : points) array.push_back(to_json(p));
  return array;
}

}  // namespace goshawk::cli
