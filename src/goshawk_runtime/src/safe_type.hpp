#pragma once

#include <fastdds/dds/topic/TopicDataType.hpp>

#include <cstring>
#include <exception>

#include "payload_check.hpp"

namespace goshawk::runtime {

/// Can explain why it does not decode a payload.
class Explains {
 public:
  virtual ~Explains() = default;
  virtual std::string fault_of(const eprosima::fastrtps::rtps::SerializedPayload_t& p) const = 0;
};

/// A generated PubSubType made safe (docs/adr/0002). Generated code throws while it decodes a bool
/// byte of 7, a sequence longer than the payload or without memory, which would end the process:
/// here such a sample is not decoded. A payload that claims more than it brings is not even tried.
/// Loans are off because the generated is_plain is wrong for types with padding. There are no keys.
template <typename PubSubType>
class SafeType : public PubSubType, public Explains {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  bool serialize(void* data, Payload* payload) override {
    // The generated code skips padding: without this, bytes of other messages would be sent, and
    // the same message would not have the same bytes twice.
    std::memset(payload->data, 0, payload->max_size);
    try {
      return PubSubType::serialize(data, payload);
    } catch (const std::exception&) {
      return false;
    }
  }

  bool deserialize(Payload* payload, void* data) override {
    if (!fault_of(*payload).empty()) return false;
    try {
      return PubSubType::deserialize(payload, data);
    } catch (const std::exception&) {
      return false;
    }
  }

  std::string fault_of(const Payload& payload) const override {
    return check_.fault_of({payload.data, payload.length});
  }

  bool is_bounded() const override { return false; }
  bool is_plain() const override { return false; }
  bool construct_sample(void*) const override { return false; }

 private:
  PayloadCheck check_{PubSubType().getName()};
};

}  // namespace goshawk::runtime
