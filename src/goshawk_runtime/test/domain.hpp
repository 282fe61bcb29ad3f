#pragma once

#include "goshawk/runtime/node.hpp"
#include "goshawk/runtime/private_domain.hpp"

namespace goshawk::runtime_test {

/// One for this program, so that tests at the same time do not meet.
inline int domain() {
  static const int held = runtime::hold_private_domain().value();
  return held;
}

inline std::unique_ptr<runtime::Context> join(std::vector<std::string> node_names = {}) {
  runtime::ContextOptions options;
  options.domain = domain();
  options.node_names = std::move(node_names);
  auto context = runtime::Context::create(options);
  if (!context) throw std::runtime_error(context.error().message);
  return *std::move(context);
}

/// Serves the node until done(), for at most `most_s`. @return done()
template <typename Done>
bool spin_until(runtime::Node& node, const Done& done, double most_s = 60.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(most_s);
  while (!done() && std::chrono::steady_clock::now() < end) node.spin_some(0.02);
  return done();
}

}  // namespace goshawk::runtime_test
