#include "goshawk/stage/stage_reporter.hpp"

#include <fmt/format.h>
#include <spdlog/logger.h>

#include <bit>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/status.hpp"

namespace goshawk::stage {

namespace {

constexpr std::int64_t kComplainEvery_ns = 1'000'000'000;
constexpr double kRefusalsEvery_s = 1.0;

}  // namespace

StageReporter::StageReporter(runtime::Node& node, StageRole role, std::string implementation)
    : node_(node),
      // Latched and deep: nodes that start later still learn which stages are ready.
      publisher_(node.advertise<goshawk_msgs::msg::StageReport>("stage_report",
                                                                runtime::Qos::latched(20))) {
  report_.stage(conversions::to_msg(role));
  report_.node(node.full_name());
  report_.implementation(std::move(implementation));
  node.on_second_writer([this](const Error& error) { fault(error); });
  node.every(kRefusalsEvery_s, [this] { tell_of_refusals(); });
}

// As the log has them: after the 1st, 2nd, 4th, 8th.
void StageReporter::tell_of_refusals() {
  const std::uint64_t count = node_.refused_datagrams();
  if (std::bit_width(count) == std::bit_width(refused_)) return;
  refused_ = count;
  publish(0, ErrorCode::invalid_input,
          fmt::format("{} malformed or forged datagrams were refused so far; the last one: {}", count,
                      node_.last_refusal()),
          {}, {{conversions::kRefusedDatagrams, double(count)}});
}

void StageReporter::set_implementation(std::string implementation) {
  report_.implementation(std::move(implementation));
}

void StageReporter::ready(const std::string& message) {
  node_.log().info("ready: {}", message);
  publish(0, ErrorCode::ok, "ready: " + message, {}, {});
}

void StageReporter::fault(const Error& error) {
  node_.log().warn("{}: {}", to_string(error.code), error.message);
  publish(0, error.code, error.message, {}, {});
}

void StageReporter::complain(const Error& error) {
  const std::int64_t now_ns = node_.monotonic_ns(), since_ns = now_ns - complained_ns_;
  // Simulated time begins anew with its simulation.
  if (complained_ns_ != 0 && since_ns >= 0 && since_ns < kComplainEvery_ns) return;
  complained_ns_ = now_ns;
  fault(error);
}

void StageReporter::answered(std::uint64_t request_id, Timing timing, Counters counters,
                             const std::string& note) {
  node_.log().debug("request {}: ok, {} us", request_id, timing.compute_ns / 1000);
  publish(request_id, ErrorCode::ok, note, timing, counters);
}

void StageReporter::failed(std::uint64_t request_id, const Error& error, Timing timing) {
  node_.log().warn("request {}: {}: {}", request_id, to_string(error.code), error.message);
  publish(request_id, error.code, error.message, timing, {});
}

void StageReporter::not_sent(std::uint64_t request_id, const Error& error) {
  if (request_id == 0) return complain(error);
  failed(request_id, error);
}

void StageReporter::publish(std::uint64_t request_id, ErrorCode code, const std::string& message,
                            Timing timing, Counters counters) {
  report_.header().stamp(conversions::to_stamp(node_.now_ns()));
  report_.request_id(request_id);
  report_.code(std::string(to_string(code)));
  report_.message(message);
  report_.wire_ns(timing.wire_ns);
  report_.compute_ns(timing.compute_ns);
  report_.counters().clear();
  for (const auto& [name, value] : counters) {
    goshawk_msgs::msg::Counter counter;
    counter.name(name);
    counter.value(value);
    report_.counters().push_back(std::move(counter));
  }
  if (auto status = publisher_.publish(report_); !status) {
    node_.log().error("{}", status.error().message);
  }
}

}  // namespace goshawk::stage
