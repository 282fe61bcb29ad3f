#pragma once

#include <memory>
#include <utility>

#include "goshawk/path_search/path_search.hpp"

namespace goshawk::path_search {

/// The stage with a map, for tests. @pre the config is valid
inline PathSearch stage_on(const Config& config, std::shared_ptr<const VoxelGrid> map) {
  PathSearch search = std::move(PathSearch::create(config)).value();
  search.set_map(std::move(map));
  return search;
}

}  // namespace goshawk::path_search
