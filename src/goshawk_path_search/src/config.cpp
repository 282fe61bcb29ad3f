#include "goshawk/path_search/config.hpp"

namespace goshawk::path_search {

Status check(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  return faults.status();
}

}  // namespace goshawk::path_search
