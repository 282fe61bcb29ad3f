#pragma once

#include <string>
#include <vector>

namespace goshawk::introspection {

/// `goshawk param VERB ...` with the arguments behind `param`:
///
///     list [NODE]                      its parameters as they are; without: installed components
///     get NODE [NAME ...]              values
///     set NODE NAME VALUE [...]        changes a node that runs: all at once, or none
///     describe COMPONENT [NAME ...]    type, unit, default, range, meaning, from the installed
///                                      component itself; /NODE asks one that runs
///     dump NODE                        all values, as a file for --params-file
///
/// @return exit status: 0; 1 where no such node answered in time; 2 for a wrong call, or where the
/// node refused (the sentence names the nearest component, node or parameter)
int param_command(std::vector<std::string> arguments);

}  // namespace goshawk::introspection
