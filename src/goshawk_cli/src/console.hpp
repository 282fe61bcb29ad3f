#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "goshawk/core/result.hpp"

namespace goshawk::cli {

using Json = nlohmann::ordered_json;

/// Exit statuses of every verb.
inline constexpr int kDone = 0;
inline constexpr int kNotDone = 1;    // a correct call without the wanted outcome; the code says why
inline constexpr int kWrongCall = 2;  // an argument, a parameter or a file of parameters is wrong

/// How a verb speaks: sentences for people on stderr, results on stdout, and with --json one object
/// a line, failures included. Every verb fails through here, so all of them fail alike.
class Console {
 public:
  /// @param name of the call behind "goshawk ", as in "topic echo"
  Console(std::string name, bool json) : name_(std::move(name)), json_(json) {}

  bool json() const { return json_; }
  const std::string& name() const { return name_; }

  /// A failure: {"ok": false, "code": ..., "message": ...}, or a line on stderr.
  /// @return kNotDone, or kWrongCall
  int not_done(const Error& error) const;
  int wrong_call(const Error& error) const;
  /// A wrong call if the code is invalid_parameter, otherwise not done.
  int failed(const Error& error) const;

  /// A sentence on stderr that is not a failure: progress, a warning.
  void say(const std::string& sentence) const;

  /// One object on stdout, indented. Bytes that are not UTF-8 are replaced.
  void print(const Json& object) const;
  /// One object on a line of its own, for verbs that print many.
  void print_line(const Json& object) const;

 private:
  int fail(const Error& error, int status) const;

  std::string name_;
  bool json_;
};

/// One line; bytes that are not UTF-8 are replaced.
std::string to_line(const Json& object);

/// {"ok": true, "code": "ok", "message": ""}: what a result begins with.
Json ok_json();

}  // namespace goshawk::cli
