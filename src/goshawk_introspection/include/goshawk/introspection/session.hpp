#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/introspection/interruptible.hpp"
#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/node.hpp"

namespace goshawk::introspection {

/// A visit to the domain under a node name that lists omit. Ctrl-C ends its waits.
class Session {
 public:
  static Result<std::unique_ptr<Session>> open();

  runtime::Context& context() const { return *context_; }
  runtime::Node& node() { return *node_; }

  /// Waits until done() holds. @return whether it did, within timeout_s and without Ctrl-C
  bool wait_for(double timeout_s, const std::function<bool()>& done);
  /// Waits until there are participants and none has joined for a moment.
  void settle(double timeout_s);
  /// The same for any count.
  void settle(double timeout_s, const std::function<int()>& count);
  std::vector<runtime::EndpointInfo> endpoints_of(const std::string& topic) const;
  /// Names of all nodes, those of one process together.
  std::vector<std::string> nodes() const;

  /// For a topic that does not exist: invalid_parameter that names the nearest one, or
  /// stage_silent.
  Error no_topic(const std::string& topic, double timeout_s) const;
  /// For a node that does not exist: stage_silent that names the nearest one.
  Error no_node(const std::string& node) const;
  /// For a topic that nobody reads: the same as for one that does not exist.
  Error no_reader(const std::string& topic, const std::string& type) const;

 private:
  std::string nearest_topic(const std::string& topic) const;

  Interruptible interruptible_;
  std::unique_ptr<runtime::Context> context_;
  std::unique_ptr<runtime::Node> node_;
};

/// "path" and "/path" are the same topic. @return invalid_parameter for an invalid name
Result<std::string> full_topic_name(const std::string& topic);

/// The same for a topic, or for the beginning of some: "/uav1/*".
Result<std::string> full_topic_pattern(const std::string& pattern);
/// Whether a topic is one of these, or begins like one that ends in '*'.
bool matches(const std::vector<std::string>& patterns, const std::string& topic);

}  // namespace goshawk::introspection
