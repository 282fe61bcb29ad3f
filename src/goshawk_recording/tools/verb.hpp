#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/runtime/context.hpp"

namespace goshawk::recording {

using Json = nlohmann::ordered_json;

inline constexpr int kDone = 0;
inline constexpr int kNotDone = 1;    // a correct call without the wanted outcome
inline constexpr int kWrongCall = 2;  // exit status

/// Parses a verb's arguments. @return nothing to go on, or the exit status (help: 0, wrong: 2)
std::optional<int> parse(CLI::App& app, std::vector<std::string> arguments);

/// A sentence on stderr, or one object {ok, code, message} on stdout.
int report_failure(const std::string& verb, const Error& error, bool json, int status);
void say(const std::string& verb, const std::string& sentence);
void print_json(const Json& object);

/// From construction to destruction SIGINT and SIGTERM only set a flag, and a file that grows
/// beyond its limit is an error, not a signal.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  static bool interrupted();
};

/// Joins the domain of the environment, under a node name that lists leave out.
Result<std::unique_ptr<runtime::Context>> join_domain();

/// "path" and "/path" are the same topic here. @return invalid_input for what is no name
Result<std::string> full_topic_name(const std::string& topic);

/// Whether a topic is chosen: by its full name, or by one that ends in '*'.
bool matches(const std::vector<std::string>& patterns, const std::string& topic);

}  // namespace goshawk::recording
