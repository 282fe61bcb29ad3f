#pragma once

#include <fmt/format.h>

#include <set>
#include <string>
#include <vector>

#include "goshawk/conformance/conform.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"

namespace goshawk::conformance {

/// Collects faults under a name; the item has passed if there are none.
class Tally {
 public:
  explicit Tally(std::string name) : name_(std::move(name)) {}
  void check(bool good, const std::string& fault) {
    ++checked_;
    if (!good && faults_++ == 0) first_ = fault;
  }
  int checked() const { return checked_; }
  Item item() const {
    if (checked_ == 0) return {name_, false, "there was nothing to examine"};
    if (faults_ == 0) return {name_, true, fmt::format("{} of them", checked_)};
    return {name_, false, fmt::format("{} of {}: {}", faults_, checked_, first_)};
  }

 private:
  std::string name_;
  int checked_ = 0, faults_ = 0;
  std::string first_;
};

inline runtime::RosArgs in_namespace(const std::string& node_namespace) {
  runtime::RosArgs args;
  args.node_namespace = node_namespace;
  return args;
}

/// What a stage reports about itself and about requests.
class ReportListener {
 public:
  ReportListener(runtime::Node& node, std::string_view stage)
      : role_(stage_role_of(stage).value()) {
    node.subscribe<goshawk_msgs::msg::StageReport>(
        "stage_report", runtime::Qos::latched(1000),
        [this](const goshawk_msgs::msg::StageReport& m, const auto&) { take(m); });
  }

  bool ready() const { return ready_; }
  const std::string& implementation() const { return implementation_; }
  /// From here on keeps the reports of this request only (0: of the stage itself).
  void listen(std::uint64_t request_id) {
    id_ = request_id;
    reports_.clear();
  }
  const std::vector<goshawk_msgs::msg::StageReport>& reports() const { return reports_; }
  bool failed() const { return !reports_.empty() && reports_.back().code() != "ok"; }

  /// "refuses NAME": exactly one report since listen(), with one of the codes and a sentence.
  Item refusal(const std::string& name, const std::set<std::string>& codes) const;

 private:
  void take(const goshawk_msgs::msg::StageReport& m) {
    if (conversions::stage_role_of(m.stage()) != role_) return;
    implementation_ = m.implementation();
    if (m.request_id() == 0 && m.code() == "ok") ready_ = true;
    if (m.request_id() == id_) reports_.push_back(m);
  }

  StageRole role_;
  std::string implementation_;
  bool ready_ = false;
  std::uint64_t id_ = 0;
  std::vector<goshawk_msgs::msg::StageReport> reports_;
};

/// Fills the latencies of a report; without samples they stay zero.
void add_latency(Report& report, std::vector<double> latencies_s);

}  // namespace goshawk::conformance
