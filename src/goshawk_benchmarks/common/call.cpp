#include "common/call.hpp"

#include <fmt/format.h>

namespace goshawk::bench {

int report_failure(const std::string& name, bool json, const Error& error) {
  const std::string code(to_string(error.code));
  if (json) {
    const nlohmann::ordered_json object{
        {"ok", false}, {"code", code}, {"message", error.message}};
    fmt::print("{}\n", object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print(stderr, "goshawk bench {}: {}: {}\n", name, code, error.message);
  }
  return 1;
}

int bench_call(int argc, char** argv, const std::string& name,
               const std::function<int(const Call&)>& run) {
  const Call call = argc == 2 ? Call::parse(argv[1], nullptr, false) : Call();
  if (!call.is_object()) {
    fmt::print(stderr, "this program takes its options from goshawk: call goshawk bench {}\n",
               name);
    return 2;
  }
  try {
    return run(call);
  } catch (const std::exception& error) {
    return report_failure(name, call.value("json", false), {ErrorCode::io_failed, error.what()});
  }
}

}  // namespace goshawk::bench
