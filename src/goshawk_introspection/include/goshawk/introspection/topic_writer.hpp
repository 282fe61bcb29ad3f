#pragma once

#include <string>
#include <vector>

#include "goshawk/introspection/schema.hpp"
#include "goshawk/introspection/session.hpp"

namespace goshawk::introspection {

/// Writes messages on a topic with a quality of service that suits every reader.
class TopicWriter {
 public:
  /// @return invalid_parameter for an invalid name or type
  static Result<TopicWriter> open(Session& session, const std::string& topic,
                                  const std::string& type);

  const std::string& topic() const { return topic_; }
  std::string type() const { return std::string(type_->name); }

  /// @param message JSON or YAML. @return invalid_parameter that says what is wrong with it
  static Result<std::vector<unsigned char>> encode(const std::string& type,
                                                   const std::string& message);

  int readers() const { return publisher_.matched(); }
  /// Waits until the topic has that many readers and no new ones appear, so that all of them get
  /// the next message.
  /// @return why fewer came: invalid_parameter that names the nearest topic, or stage_silent;
  /// cancelled on Ctrl-C
  Status wait_for_readers(int wanted, double timeout_s);
  /// @return io_failed
  Status publish(const std::vector<unsigned char>& bytes);
  /// Waits until the last message has arrived. @return stage_silent if it was not confirmed
  Status wait_arrival(double timeout_s);

 private:
  TopicWriter(Session& session, std::string topic, const Type& type);

  Session* session_;
  std::string topic_;
  const Type* type_;
  runtime::RawPublisher publisher_;
};

}  // namespace goshawk::introspection
