#pragma once

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

namespace goshawk::runtime {

/// For what belongs to a participant, and to none of its nodes.
inline spdlog::logger& runtime_log() {
  static const auto logger = [] {
    auto made = std::make_shared<spdlog::logger>("goshawk_runtime",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
    made->set_pattern("%Y-%m-%d %H:%M:%S.%e [%n] %l: %v");
    return made;
  }();
  return *logger;
}

}  // namespace goshawk::runtime
