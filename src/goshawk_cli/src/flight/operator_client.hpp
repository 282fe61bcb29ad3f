#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "goshawk/core/result.hpp"
#include "goshawk/introspection/session.hpp"
#include "goshawk/mission/mission.hpp"
#include "goshawk_msgs.h"

namespace goshawk::cli {

/// Commands a flight that runs, and hears the answers. What is not answered is sent again: the
/// stages carry it out once.
class OperatorClient {
 public:
  /// @param space of the vehicle: "/uav1", or "/"
  OperatorClient(introspection::Session& session, const std::string& space);

  /// @param verb of OperatorCommand @param height_m of a takeoff
  /// @return the stage's sentence; its code and sentence if it refuses; stage_silent if none
  ///   answers within timeout_s; cancelled by Ctrl-C
  Result<std::string> command(std::uint8_t verb, double height_m, double timeout_s);
  /// The same for a mission, whose id and client are set here. @return the mission's id
  Result<std::uint64_t> fly(mission::Mission mission, double timeout_s);

 private:
  struct Question {
    std::uint64_t id;
    std::string topic;  // full name
    bool to_mission;    // the stage that flies missions answers, not the navigator
  };
  Result<std::string> ask(const Question& question, const std::function<Status()>& send,
                          double timeout_s);
  Error silence(const Question& question, double waited_s) const;

  introspection::Session& session_;
  std::string space_;
  std::string client_;
  runtime::Publisher<goshawk_msgs::msg::OperatorCommand> commands_;
  runtime::Publisher<goshawk_msgs::msg::Mission> missions_;
  std::optional<goshawk_msgs::msg::OperatorAnswer> answer_ = {};
};

}  // namespace goshawk::cli
