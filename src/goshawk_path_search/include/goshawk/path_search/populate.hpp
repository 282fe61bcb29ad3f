#pragma once

#include <cstddef>

namespace goshawk::path_search {

/// Asks for the pages of this memory now, all at once. Otherwise each comes when it is first
/// touched, one by one, and a search that runs over new memory takes many times as long as the same
/// search again. Contents do not change. A system that does not know the request is left to bring
/// the pages as they are touched.
void populate(void* memory, std::size_t bytes);

}  // namespace goshawk::path_search
