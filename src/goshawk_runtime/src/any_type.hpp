#pragma once

#include <fastdds/dds/topic/TopicDataType.hpp>
#include <string>

#include "safe_type.hpp"

namespace goshawk::runtime {

/// What goes through the middleware: an object, and the type that knows how to (de)serialise it.
struct Sample {
  eprosima::fastdds::dds::TopicDataType* type = nullptr;
  void* object = nullptr;
  bool decoded = false;  // written by deserialize(); if false:
  std::string fault{};   // why, if more is known than that it is another type's
};

/// The type that topics are registered with. A participant knows one type a name and one topic a
/// name, but here one endpoint may read /path as structs and another one as raw bytes: each brings
/// its own decoder inside the Sample.
///
/// Decoding never fails towards the middleware, whose answer to a failure changes between versions
/// (2.9 drops the sample in silence): the sample says whether it decoded.
class AnyType : public eprosima::fastdds::dds::TopicDataType {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  AnyType(const std::string& wire_name, std::uint32_t type_size) {
    setName(wire_name.c_str());
    m_typeSize = type_size;
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, Payload* payload) override {
    const auto& sample = *static_cast<Sample*>(data);
    return sample.type->serialize(sample.object, payload);
  }
  bool deserialize(Payload* payload, void* data) override {
    auto& sample = *static_cast<Sample*>(data);
    sample.decoded = sample.type != nullptr && sample.type->deserialize(payload, sample.object);
    if (sample.decoded) return true;
    const auto* explains = dynamic_cast<const Explains*>(sample.type);
    sample.fault = explains == nullptr ? "" : explains->fault_of(*payload);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    const auto& sample = *static_cast<Sample*>(data);
    return sample.type->getSerializedSizeProvider(sample.object);
  }
  void* createData() override { return new Sample; }
  void deleteData(void* data) override { delete static_cast<Sample*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

}  // namespace goshawk::runtime
