#include "goshawk/runtime/message_type.hpp"

#include <algorithm>

#include "message_type_impl.hpp"

namespace goshawk::runtime {
namespace {

using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;
using Bytes = std::vector<unsigned char>;

/// Samples are the payload itself.
class RawType : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit RawType(const std::string& wire_name) {
    setName(wire_name.c_str());
    m_typeSize = 1024;  // initial size of the history's buffers; they grow
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, Payload* payload) override {
    const auto& bytes = *static_cast<const Bytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::ranges::copy(bytes, payload->data);
    payload->length = unsigned(bytes.size());
    payload->encapsulation = !bytes.empty() && bytes.size() > 1 && bytes[1] == 1 ? CDR_LE : CDR_BE;
    return true;
  }
  bool deserialize(Payload* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return std::uint32_t(static_cast<const Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

}  // namespace

MessageType::MessageType(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MessageType::~MessageType() = default;
MessageType::MessageType(MessageType&&) noexcept = default;
const std::string& MessageType::name() const {
  return impl_->name;
}

MessageType raw_message_type(const std::string& wire_name) {
  auto impl = std::make_unique<MessageType::Impl>();
  impl->name = wire_name;
  impl->support.reset(new RawType(wire_name));
  return MessageType(std::move(impl));
}

Bytes encode(const MessageType& type, const void* message) {
  auto& support = const_cast<eprosima::fastdds::dds::TypeSupport&>(type.impl().support);
  void* data = const_cast<void*>(message);
  Payload payload(support->getSerializedSizeProvider(data)());
  if (!support.serialize(data, &payload)) throw std::logic_error("encode: " + type.name());
  return {payload.data, payload.data + payload.length};
}

bool decode(const MessageType& type, const Bytes& bytes, void* message) {
  auto& support = const_cast<eprosima::fastdds::dds::TypeSupport&>(type.impl().support);
  Payload payload(unsigned(bytes.size()));
  std::ranges::copy(bytes, payload.data);
  payload.length = unsigned(bytes.size());
  return support.deserialize(&payload, message);
}

}  // namespace goshawk::runtime
