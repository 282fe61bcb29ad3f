#pragma once

#include "goshawk/core/result.hpp"
#include "goshawk/recording/format.hpp"

namespace goshawk::recording {

/// Unpacks LZ4 frames one after another, as MCAP's chunks with compression lz4 hold them; all
/// checksums are checked. Memory grows with what is unpacked, not with what is claimed.
/// @param most [byte] unpacks to no more @return invalid_input with a clause that names the fault
Result<Bytes> unpack_lz4(View packed, std::size_t most);

}  // namespace goshawk::recording
