#pragma once

#include <string>
#include <vector>

namespace goshawk::introspection {

/// `goshawk topic VERB ...` with the arguments behind `topic`:
///
///     list [-t]                      topics of the domain; -t with types
///     info TOPIC                     type, who writes, who reads, with which quality of service
///     echo TOPIC [--once | -n N] [--no-arr]
///     hz TOPIC [--window N] [-n N]   rate at which messages come
///     delay TOPIC [--window N] [-n N]    from the header's stamp to the arrival here
///     bw TOPIC [--window N] [-n N]   bytes a second
///     pub TOPIC TYPE JSON_OR_YAML [--once | -r HZ] [-n N]
///
/// Each with --json (one object a line, keys in README.md) and --timeout S. Ctrl-C ends any.
/// @return exit status: 0; 1 where nothing was there or came in time; 2 for a wrong call
int topic_command(std::vector<std::string> arguments);

}  // namespace goshawk::introspection
