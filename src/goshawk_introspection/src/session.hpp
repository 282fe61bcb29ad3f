#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/node.hpp"

namespace goshawk::introspection {

inline constexpr int kNothing = 1;    // exit status: nothing was there, or came in time
inline constexpr int kWrongCall = 2;  // exit status

/// What every verb takes.
struct CommonOptions {
  bool json = false;
  double timeout_s = 2.0;
};

int say_wrong_call(const std::string& sentence);
int say_nothing(const std::string& sentence);

/// One word of `goshawk topic`, `goshawk node`, ...
struct Verb {
  std::string name;
  std::string summary;
  /// Adds its own options to app. @return what to do once they are parsed
  std::function<std::function<int()>(CLI::App& app, CommonOptions& common)> prepare;
  double timeout_s = 2.0;  // unless --timeout says otherwise
};

/// Parses and runs a command that is one verb. @param name behind "goshawk "
int run_one(const std::string& name, const Verb& verb, std::vector<std::string> arguments);

/// Finds the verb, parses, runs. A wrong call is a sentence and status 2; bugs throw.
int run_verb(const std::string& command, const std::vector<Verb>& verbs,
             std::vector<std::string> arguments);

/// From construction to destruction SIGINT and SIGTERM only set a flag; at the end the handlers
/// of before are back.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  static bool interrupted();
};

/// A visit to the domain, under a node name that lists leave out.
class Session {
 public:
  static Result<std::unique_ptr<Session>> open();

  runtime::Context& context() const { return *context_; }
  runtime::Node& node() { return *node_; }

  /// Waits until done() holds. @return whether it did, within timeout_s and without Ctrl-C
  bool wait_for(double timeout_s, const std::function<bool()>& done);
  /// Waits until somebody is there and nobody new came for a moment.
  void settle(double timeout_s);
  /// The same of anything that is counted.
  void settle(double timeout_s, const std::function<int()>& count);
  std::vector<runtime::EndpointInfo> endpoints_of(const std::string& topic) const;
  /// @return the sentence for a topic that is not there, with the nearest one, and exit status
  int say_no_topic(const std::string& topic, double timeout_s) const;
  /// @return the sentence for a topic that nobody reads, with the nearest one, and exit status
  int say_no_reader(const std::string& topic, const std::string& type) const;

 private:
  std::string nearest_topic(const std::string& topic) const;

  Interruptible interruptible_;
  std::unique_ptr<runtime::Context> context_;
  std::unique_ptr<runtime::Node> node_;
};

/// "path" and "/path" are the same topic here. @return invalid_input for what is no name
Result<std::string> full_topic_name(const std::string& topic);

}  // namespace goshawk::introspection
