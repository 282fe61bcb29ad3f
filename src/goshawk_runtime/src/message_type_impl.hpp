#pragma once

#include <fastdds/dds/topic/TypeSupport.hpp>

#include "goshawk/runtime/message_type.hpp"

namespace goshawk::runtime {

struct MessageType::Impl {
  std::string name;
  eprosima::fastdds::dds::TypeSupport support;
};

}  // namespace goshawk::runtime
