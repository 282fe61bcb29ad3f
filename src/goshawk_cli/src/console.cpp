#include "console.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace goshawk::cli {
namespace {

// What is told must be out before this process becomes another, or is killed.
void print_flushed(const std::string& text, std::FILE* out) {
  fmt::print(out, "{}\n", text);
  std::fflush(out);
}

}  // namespace

std::string to_line(const Json& object) {
  return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json ok_json() {
  return {{"ok", true}, {"code", "ok"}, {"message", ""}};
}

int Console::fail(const Error& error, int status) const {
  const std::string code(to_string(error.code));
  if (json_) {
    print_line({{"ok", false}, {"code", code}, {"message", error.message}});
  } else {
    say(fmt::format("{}: {}", code, error.message));
  }
  return status;
}

int Console::not_done(const Error& error) const {
  return fail(error, kNotDone);
}

int Console::wrong_call(const Error& error) const {
  return fail(error, kWrongCall);
}

int Console::failed(const Error& error) const {
  return fail(error, error.code == ErrorCode::invalid_parameter ? kWrongCall : kNotDone);
}

void Console::say(const std::string& sentence) const {
  print_flushed(fmt::format("goshawk{}{}: {}", name_.empty() ? "" : " ", name_, sentence), stderr);
}

void Console::print(const Json& object) const {
  print_flushed(object.dump(2, ' ', false, Json::error_handler_t::replace), stdout);
}

void Console::print_line(const Json& object) const {
  print_flushed(to_line(object), stdout);
}

}  // namespace goshawk::cli
