#pragma once

#include <chrono>
#include <memory>
#include <stdexcept>

#include "goshawk/runtime/node.hpp"
#include "goshawk/runtime/private_domain.hpp"

namespace goshawk::stage_test {

inline std::unique_ptr<runtime::Context> join() {
  static const int domain = runtime::hold_private_domain().value();
  runtime::ContextOptions options;
  options.domain = domain;
  auto context = runtime::Context::create(options);
  if (!context) throw std::runtime_error(context.error().message);
  return *std::move(context);
}

/// A stage's node, whose clock the test sets, and another node in a participant of its own.
struct TwoNodes {
  std::shared_ptr<runtime::ManualClock> clock = std::make_shared<runtime::ManualClock>();
  std::unique_ptr<runtime::Context> here = join();
  std::unique_ptr<runtime::Context> there = join();
  runtime::Node stage{*here, "renamed", {}, clock};
  runtime::Node other{*there, "other"};

  /// Serves both until done(), for a minute at most. @return done()
  template <typename Done>
  bool spin_until(const Done& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!done() && std::chrono::steady_clock::now() < end) {
      stage.spin_some(0.0);
      other.spin_some(0.01);
    }
    return done();
  }
};

}  // namespace goshawk::stage_test
