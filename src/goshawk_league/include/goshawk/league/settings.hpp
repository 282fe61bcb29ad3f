#pragma once

#include <filesystem>
#include <string>

#include "goshawk/closed_loop/flight_lab.hpp"

namespace goshawk::league {

/// Sets one parameter of a stage: "tracker:max_tilt_rad=1.0", by the names of docs/parameters.md
/// (nodes navigator, tracker, simulator, path_search, corridor_builder, trajectory_optimizer).
/// @return invalid_parameter: no such node or parameter, or no value of its type. What the stages
///   refuse, they refuse when they are made
Status apply_setting(const std::string& setting, closed_loop::Setup& setup);

/// Sets what a ROS style parameter file says: under each node's name, ros__parameters.
/// @return io_failed, or invalid_parameter as above or for a file of another form
Status apply_file(const std::filesystem::path& file, closed_loop::Setup& setup);

}  // namespace goshawk::league
