#pragma once

#include <filesystem>
#include <string>

#include "goshawk/core/result.hpp"

namespace goshawk::flight_report {

/// @return io_failed, naming the file, if any of the bytes could not be written
Status write_file(const std::filesystem::path& file, const std::string& bytes);

}  // namespace goshawk::flight_report
