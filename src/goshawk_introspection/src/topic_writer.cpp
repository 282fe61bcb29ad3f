#include "goshawk/introspection/topic_writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "goshawk/introspection/codec.hpp"
#include "goshawk/introspection/text.hpp"
#include "goshawk/runtime/message_type.hpp"

namespace goshawk::introspection {
namespace {

Error as_parameter(const Error& error) {
  return fail(ErrorCode::invalid_parameter, error.message);
}

}  // namespace

TopicWriter::TopicWriter(Session& session, std::string topic, const Type& type)
    : session_(&session),
      topic_(std::move(topic)),
      type_(&type),
      // Reliable and latched matches every reader, whatever it asks for.
      publisher_(session.node().advertise_raw(
          topic_, runtime::raw_message_type(runtime::wire_type_name(std::string(type.name))),
          runtime::Qos::latched(1))) {}

Result<TopicWriter> TopicWriter::open(Session& session, const std::string& topic,
                                      const std::string& type) {
  auto name = full_topic_name(topic);
  if (!name) return name.error();
  const auto found = find_type(type);
  if (!found) return as_parameter(found.error());
  return TopicWriter(session, *std::move(name), **found);
}

Result<std::vector<unsigned char>> TopicWriter::encode(const std::string& type,
                                                       const std::string& message) {
  const auto found = find_type(type);
  if (!found) return as_parameter(found.error());
  const auto json = parse_json_or_yaml(message);
  if (!json) return as_parameter(json.error());
  auto bytes = json_to_cdr(**found, *json);
  if (!bytes) return as_parameter(bytes.error());
  return bytes;
}

Status TopicWriter::wait_for_readers(int wanted, double timeout_s) {
  if (!session_->wait_for(timeout_s, [&] { return readers() >= wanted; })) {
    if (Interruptible::interrupted()) return fail(ErrorCode::cancelled, "interrupted");
    if (readers() == 0) return session_->no_reader(topic_, type());
    return fail(ErrorCode::stage_silent,
                fmt::format("only {} of {} readers of {} came, nothing was published", readers(),
                            wanted, topic_));
  }
  session_->settle(timeout_s, [this] { return readers(); });
  return success();
}

Status TopicWriter::publish(const std::vector<unsigned char>& bytes) {
  return publisher_.publish_raw(&bytes);
}

Status TopicWriter::wait_arrival(double timeout_s) {
  if (publisher_.wait_acknowledged(timeout_s)) return success();
  return fail(ErrorCode::stage_silent, "a subscriber did not confirm the last message");
}

}  // namespace goshawk::introspection
