#pragma once

#include <string>
#include <utility>
#include <vector>

#include "goshawk/runtime/parameters.hpp"
#include "goshawk/introspection/session.hpp"

namespace goshawk::introspection {

/// A parameter as a node tells it; with old_value if it was set.
struct LiveParameter {
  runtime::ParameterDescription description;
  std::string old_value;
};

/// What is asked of a node: its verb, and names (get) or names and values (set).
struct ParameterQuestion {
  std::string node;  // full name
  std::string verb;  // "get", "set"
  std::vector<std::pair<std::string, std::string>> parameters;
};

/// Asks until the node answers: it does what was asked once, however often it hears it.
/// @return the node's own refusal as invalid_parameter, or stage_silent: no node of that name
/// answered within timeout_s, or other nodes are there and none of that name (the sentence tells
/// which, and the nearest name)
Result<std::vector<LiveParameter>> ask(Session& session, const ParameterQuestion& question,
                                       double timeout_s);

}  // namespace goshawk::introspection
