#include "goshawk/runtime/version.hpp"

#include <fastrtps/config.h>

namespace goshawk::runtime {

std::string version() {
  return GOSHAWK_VERSION;
}
std::string middleware_version() {
  return FASTRTPS_VERSION_STR;
}

}  // namespace goshawk::runtime
