#pragma once

#include "goshawk/core/result.hpp"
#include "goshawk/recording/format.hpp"

namespace goshawk::recording {

/// Unpacks LZ4 frames one after another (Collet, "LZ4 Frame Format Description" 1.6.4, and "LZ4
/// Block Format Description"), as MCAP's chunks with compression lz4 hold them. The bytes are not
/// trusted: no length is taken further than the bytes go, and all checksums are checked.
/// @param most [byte] unpacks to no more @return invalid_input with a clause that names the fault
Result<Bytes> unpack_lz4(View packed, std::size_t most);

/// The checksum of those frames: xxHash, 32 bits, seed 0 (Collet, "XXHash specification" 0.1.1).
std::uint32_t xxh32(View bytes);

}  // namespace goshawk::recording
