#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/vector.hpp"
#include "program.hpp"

namespace goshawk::cli {

/// Options that are points: "1,2,3" [m]. What is not three numbers is a wrong call.
CLI::Option* add_point(const Verb& verb, const std::string& name, Vec3& value,
                       const std::string& what);
CLI::Option* add_point(const Verb& verb, const std::string& name, std::optional<Vec3>& value,
                       const std::string& what);
/// May repeat.
CLI::Option* add_points(const Verb& verb, const std::string& name, std::vector<Vec3>& values,
                        const std::string& what);

/// For counts and seeds.
CLI::Validator not_negative();

}  // namespace goshawk::cli
