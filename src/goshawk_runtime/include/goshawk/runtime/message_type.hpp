#pragma once

#include <memory>
#include <string>
#include <vector>

namespace goshawk::runtime {

/// A message type as the middleware sees it. Fast DDS' headers stay out of this one: they take
/// seconds to compile.
class MessageType {
 public:
  struct Impl;
  explicit MessageType(std::unique_ptr<Impl> impl);
  ~MessageType();
  MessageType(MessageType&&) noexcept;

  const std::string& name() const;  // as on the wire: "nav_msgs::msg::dds_::Path_"
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// The type of every message of idl/, instantiated once in message_types.cpp.
template <typename Message>
const MessageType& message_type();

/// A type of that wire name whose samples are their serialised bytes, std::vector<unsigned char>
/// with the 4 bytes of CDR encapsulation in front: for tools that handle any topic.
MessageType raw_message_type(const std::string& wire_name);

/// The CDR bytes (encapsulation included) of a message, and back.
/// decode @return false if the bytes are not such a message. It never throws and never takes more
/// memory than a small multiple of the bytes.
std::vector<unsigned char> encode(const MessageType& type, const void* message);
bool decode(const MessageType& type, const std::vector<unsigned char>& bytes, void* message);

template <typename Message>
std::vector<unsigned char> encode(const Message& message) {
  return encode(message_type<Message>(), &message);
}
template <typename Message>
bool decode(const std::vector<unsigned char>& bytes, Message& message) {
  return decode(message_type<Message>(), bytes, &message);
}

}  // namespace goshawk::runtime
