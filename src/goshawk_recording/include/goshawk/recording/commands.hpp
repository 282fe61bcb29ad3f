#pragma once

#include <string>
#include <vector>

namespace goshawk::recording {

/// `goshawk record [TOPICS...] [-o FILE.mcap]`: records until Ctrl-C.
/// @return exit status: 0; 1 where it could not be recorded to the end; 2 for a wrong call
int record_command(const std::vector<std::string>& arguments);

/// `goshawk replay FILE`: plays a recording over DDS.
/// @return exit status: 0; 1 where it could not be read or played; 2 for a wrong call
int replay_command(const std::vector<std::string>& arguments);

}  // namespace goshawk::recording
