#pragma once

#include "goshawk/why/why.hpp"
#include "json.hpp"

namespace goshawk::cli {

/// `binds`, `doing`, `because`, `mend`, `stage`, `parameter`, `voxel`, as docs/cli.md has them.
Json to_json(const why::Reason& reason);

}  // namespace goshawk::cli
