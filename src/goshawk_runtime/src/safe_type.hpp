#pragma once

#include <fastdds/dds/topic/TopicDataType.hpp>

#include <cstring>
#include <exception>

namespace goshawk::runtime {

/// A generated PubSubType made safe (docs/adr/0002): what the generated code throws while it
/// decodes (a bool byte of 7, a sequence longer than the payload, no memory) would end the process;
/// here it is a sample that did not decode. Loans are off, because the generated is_plain is
/// wrong for types with padding, and there are no keys.
template <typename PubSubType>
class SafeType : public PubSubType {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  bool serialize(void* data, Payload* payload) override {
    // Padding is left as it was: bytes of other messages would go out, and the same message would
    // not have the same bytes twice.
    std::memset(payload->data, 0, payload->max_size);
    try {
      return PubSubType::serialize(data, payload);
    } catch (const std::exception&) {
      return false;
    }
  }

  bool deserialize(Payload* payload, void* data) override {
    if (payload->length < 4) return false;  // no encapsulation header
    try {
      return PubSubType::deserialize(payload, data);
    } catch (const std::exception&) {
      return false;
    }
  }

  bool is_bounded() const override { return false; }
  bool is_plain() const override { return false; }
  bool construct_sample(void*) const override { return false; }
};

}  // namespace goshawk::runtime
