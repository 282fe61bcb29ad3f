#include "goshawk/map_server/odds_model.hpp"

#include <fmt/format.h>

namespace goshawk::map_server {

Result<OddsModel> OddsModel::make(int hits_needed, int misses_needed) {
  if (hits_needed < 1 || hits_needed > 4 || misses_needed < 1 || misses_needed > 9) {
    return fail(ErrorCode::invalid_parameter,
                fmt::format("hits_needed is {} and misses_needed {}: the first must be from 1 to 4, "
                            "the second from 1 to 9",
                            hits_needed, misses_needed));
  }
  OddsModel model;
  model.least = model.occupied - hits_needed * model.hit;
  model.most = model.occupied - 1 + misses_needed * model.miss;
  return model;
}

}  // namespace goshawk::map_server
