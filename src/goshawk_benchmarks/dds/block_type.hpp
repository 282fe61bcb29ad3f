#pragma once

#include <cstring>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <string>

namespace goshawk::bench {

/// A sample of a fixed number of bytes that lie in memory as they go over the wire, so that it can
/// be lent: what a copy costs can be told from what the middleware costs.
class BlockType : public eprosima::fastdds::dds::TopicDataType {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  explicit BlockType(std::uint32_t bytes) : bytes_(bytes) {
    setName(("goshawk_block_" + std::to_string(bytes)).c_str());
    m_typeSize = bytes + kEncapsulation;
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, Payload* payload) override {
    if (payload->max_size < bytes_ + kEncapsulation) return false;
    const unsigned char head[kEncapsulation] = {0, 1, 0, 0};  // CDR, little-endian
    std::memcpy(payload->data, head, kEncapsulation);
    std::memcpy(payload->data + kEncapsulation, data, bytes_);
    payload->length = bytes_ + kEncapsulation;
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(Payload* payload, void* data) override {
    if (payload->length != bytes_ + kEncapsulation) return false;
    std::memcpy(data, payload->data + kEncapsulation, bytes_);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [size = bytes_ + kEncapsulation] { return size; };
  }
  void* createData() override { return new unsigned char[bytes_]; }
  void deleteData(void* data) override { delete[] static_cast<unsigned char*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
  bool is_bounded() const override { return true; }
  bool is_plain() const override { return true; }
  bool construct_sample(void* memory) const override {
    std::memset(memory, 0, bytes_);
    return true;
  }

 private:
  static constexpr std::uint32_t kEncapsulation = 4;
  std::uint32_t bytes_;
};

}  // namespace goshawk::bench
