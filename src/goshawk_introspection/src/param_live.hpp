#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "session.hpp"

// The verbs of `goshawk param` on nodes that run. Each returns the exit status.

namespace goshawk::introspection {

int get_parameters(const CommonOptions& common, const std::string& node,
                   const std::vector<std::string>& names);
/// @param assignments NAME VALUE NAME VALUE ...
int set_parameters(const CommonOptions& common, const std::string& node,
                   const std::vector<std::string>& assignments);
int list_parameters(const CommonOptions& common, const std::string& node);
int describe_parameters(const CommonOptions& common, const std::string& node,
                        const std::vector<std::string>& names);
/// As a file for --params-file.
int dump_parameters(const CommonOptions& common, const std::string& node);

/// For people, in lines; text() of JSON for programs.
void print_description(const runtime::ParameterDescription& parameter);
nlohmann::ordered_json to_json(const runtime::ParameterDescription& parameter);

}  // namespace goshawk::introspection
