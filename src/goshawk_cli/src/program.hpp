#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "console.hpp"

namespace goshawk::cli {

using Words = std::vector<std::string>;

/// What may stand at a place. @param before the positional words before it
using Completer = std::function<Words(const Words& before)>;

class Program;

/// A word of the command line that options belong to: `plan`, or `echo` of `topic`. A handle, to be
/// copied; what it adds lives as long as the program.
class Verb {
 public:
  Verb(Program& program, CLI::App& app) : program_(&program), app_(&app) {}

  CLI::App* operator->() const { return app_; }

  /// As it is called, behind the program's name: "topic echo".
  std::string path() const;

  /// A word below this one.
  Verb word(const std::string& name, const std::string& summary) const;

  /// Ends the description: --json is added, and `run` is what runs once all is parsed.
  /// @param run @return the exit status
  void runs(std::function<int(const Console&)> run) const;

  /// Everything behind --ros-args goes to `rest`, unparsed.
  void takes_ros_args(Words& rest) const;

  /// An option whose value is one of some words: checked, named in a refusal, and completed.
  CLI::Option* choice(const std::string& name, std::string& value, const std::string& what,
                      Words choices) const;

  /// What a shell offers for the values of an option.
  void completes(const CLI::Option* option, Completer completer) const;

 private:
  Program* program_;
  CLI::App* app_;
};

/// The one parser: all verbs, their help, their wrong calls and their completion.
class Program {
 public:
  Program();

  CLI::App& app() { return app_; }
  Verb verb(const std::string& name, const std::string& summary);

  /// Parses and runs. A wrong call is a sentence that names the nearest verb or option, and status
  /// 2. @param arguments behind the program's name
  int run(Words arguments);

  /// What may follow. @param words behind the program's name, the last one unfinished, maybe empty
  Words complete(Words words) const;

  /// What is printed for `goshawk help VERB ...`: the status of a call of `VERB ... --help`.
  int help(const Words& words);

 private:
  friend class Verb;
  struct Place;

  int parse_and_run(Words arguments, bool json);
  int refuse(const CLI::ParseError& error, bool json) const;
  Place place_of(const Words& words) const;
  Words values_of(const CLI::Option* option, const Words& before) const;

  CLI::App app_;
  std::map<const CLI::App*, std::function<int(const Console&)>> runs_;
  std::map<const CLI::App*, Words*> ros_args_;
  std::map<const CLI::Option*, Completer> completers_;
  bool json_ = false;
};

}  // namespace goshawk::cli
