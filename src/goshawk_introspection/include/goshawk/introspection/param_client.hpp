#pragma once

#include <string>
#include <utility>
#include <vector>

#include "goshawk/introspection/session.hpp"
#include "goshawk/runtime/parameters.hpp"

namespace goshawk::introspection {

/// A parameter as a node reports it; old_value after a set.
struct LiveParameter {
  runtime::ParameterDescription description;
  std::string old_value;
};

enum class ParameterVerb { get, set };

/// What is asked of a node: names (get) or names and values (set).
struct ParameterQuestion {
  std::string node;  // full name
  ParameterVerb verb = ParameterVerb::get;
  std::vector<std::pair<std::string, std::string>> parameters;
};

/// Asks until the node answers; the node carries the request out once, however often it arrives.
/// @return the node's own error, or stage_silent: no such node answered within timeout_s. The
/// sentence lists the nodes that are there, or names the nearest one
Result<std::vector<LiveParameter>> ask(Session& session, const ParameterQuestion& question,
                                       double timeout_s);

}  // namespace goshawk::introspection
