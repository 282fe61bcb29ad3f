#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::cli {

using Json = nlohmann::ordered_json;
using Arguments = std::vector<std::string>;

/// Exit statuses of every verb.
inline constexpr int kDone = 0;
inline constexpr int kNotDone = 1;  // a correct call without the wanted outcome; the code says why
inline constexpr int kWrongCall = 2;  // an argument, parameter or file of parameters is wrong

/// Parses a verb's arguments. @return nothing to go on, or the exit status (help: 0, wrong: 2)
std::optional<int> parse(CLI::App& app, Arguments arguments);

/// For counts and seeds.
CLI::Validator not_negative();

/// "1,2,3" [m]. @return invalid_parameter for anything but three numbers
Result<Vec3> parse_point(const std::string& text);

/// Prints the failure: a sentence on stderr, or one object {ok, code, message} on stdout.
int report_failure(const Error& error, bool json, int status);

/// Becomes another program, command[0] being its path. @return only where that fails
int become(const Arguments& command);

/// One object on stdout; bytes that are no UTF-8 are replaced.
void print_json(const Json& object);
Json to_json(const Vec3& v);
Json to_json(const std::vector<Vec3>& points);
/// Infinities and NaN have no JSON: they become null.
Json to_json(double value);

}  // namespace goshawk::cli
