#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "goshawk/px4/config.hpp"
#include "goshawk/px4/link.hpp"

namespace goshawk::px4 {

/// Compares the layout of each message with PX4's, before anything is believed or sent: some
/// layouts differ between releases though their topics do not.
class FormatCheck {
 public:
  explicit FormatCheck(const Config& config);

  /// Asks for the next topic, again every 0.3 s.
  void step(std::int64_t now_ns, Link& link);
  /// @return invalid_parameter that names the topic and what to set, if the layouts differ
  Status hear(const MessageFormatResponse& response);

  bool done() const { return next_ == topics_.size(); }
  /// Five questions without an answer.
  bool unanswered() const { return tries_ >= 5; }
  /// "fmu/out/vehicle_status", which is asked for now. @pre !done()
  const std::string& topic() const { return topics_[next_].name; }

 private:
  struct Topic {
    std::string name;  // as PX4 wants it: without suffix
    std::string_view type;
    std::uint32_t hash;
  };
  template <typename Message>
  void add();

  Release release_;
  std::vector<Topic> topics_;
  std::size_t next_ = 0;
  int tries_ = 0;
  std::optional<std::int64_t> asked_ns_;
};

}  // namespace goshawk::px4
