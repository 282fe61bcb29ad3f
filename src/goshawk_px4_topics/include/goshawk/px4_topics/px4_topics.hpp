#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "goshawk/px4_wire/codec.hpp"
#include "goshawk/stage/stage_reporter.hpp"

namespace goshawk::px4 {

/// A node's side of PX4's topics of one release. PX4 writes best effort and keeps the last sample
/// for those who come late; it reads best effort.
class Px4Topics {
 public:
  Px4Topics(runtime::Node& node, stage::StageReporter& reporter, Release release)
      : node_(node), reporter_(reporter), release_(release) {}
  Px4Topics(const Px4Topics&) = delete;
  Px4Topics& operator=(const Px4Topics&) = delete;

  template <typename Message>
  void advertise() {
    auto definition = definition_of(Message::kType, release_);
    auto publisher = node_.advertise_raw(topic_of(Message::kTopic, definition),
                                         runtime::raw_message_type(wire_type_of(Message::kType)),
                                         {false, true, 1});
    outputs_.emplace(Message::kType,
                     Output{std::move(definition.layout), std::move(publisher), Bytes()});
  }

  /// @pre advertised
  template <typename Message>
  void send(const Message& message) {
    Output& output = outputs_.at(Message::kType);
    encode(output.layout, message, output.bytes);
    if (auto status = output.publisher.publish_raw(&output.bytes); !status) {
      reporter_.complain(status.error());
    }
  }

  /// What does not have the release's layout is reported.
  /// @param writers PX4 is one process; an autopilot hears everybody @param depth samples kept
  template <typename Message>
  void subscribe(std::function<void(const Message&)> callback, runtime::Writers writers,
                 int depth = 1) {
    const auto definition = definition_of(Message::kType, release_);
    node_.subscribe_raw(
        topic_of(Message::kTopic, definition),
        runtime::raw_message_type(wire_type_of(Message::kType)), {false, false, depth},
        [this, layout = definition.layout, callback = std::move(callback)](
            const void* bytes, const runtime::MessageInfo&) {
          const auto message = decode<Message>(layout, *static_cast<const Bytes*>(bytes));
          if (!message) return reporter_.complain(message.error());
          callback(*message);
        },
        std::move(writers));
  }

 private:
  struct Output {
    Layout layout;
    runtime::RawPublisher publisher;
    Bytes bytes;
  };

  runtime::Node& node_;
  stage::StageReporter& reporter_;
  Release release_;
  std::map<std::string_view, Output> outputs_;
};

}  // namespace goshawk::px4
