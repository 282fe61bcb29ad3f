#pragma once

#include <string>
#include <vector>

#include "console.hpp"

namespace goshawk::cli {

/// Where this program is installed: the folder above its bin/.
std::string install_prefix();

/// The HTML page that flights are put into (goshawk_viewer).
std::string page_template();

/// Becomes another program, command[0] being its path. @return only if that fails
int become(const std::vector<std::string>& command, const Console& console);

/// Becomes a program of lib/goshawk that takes its options as one JSON object: a script ("x.py") or
/// a compiled one. `json` and `prefix` are added. @return only if that fails
int become_helper(const std::string& name, Json options, const Console& console);

/// SIGINT for this process when its parent ends, however it ends.
/// @param parent its process id (0: not known): it may have ended before this process could ask
void stop_with_parent(int parent);

/// A new folder for the logs of what `goshawk` starts without a flight folder, below
/// $XDG_STATE_HOME/goshawk/log (~/.local/state/goshawk/log); the oldest ones go.
/// @param what the end of its name. @return its path, or io_failed
Result<std::string> make_log_folder(const std::string& what);

}  // namespace goshawk::cli
