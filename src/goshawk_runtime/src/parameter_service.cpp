#include "parameter_service.hpp"

#include <spdlog/logger.h>

#include <algorithm>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::runtime {
namespace {

using goshawk_msgs::msg::Parameter;
namespace verb = goshawk_msgs::msg::ParameterRequest_Constants;

constexpr std::size_t kMostGiven = 16;         // answers kept for clients that ask again
constexpr std::size_t kMostParameters = 1000;  // in one request
constexpr std::size_t kLongestName = 256;      // [byte] of clients and parameters
constexpr std::size_t kLongestValue = 4096;    // [byte]
const Qos kQos = Qos::reliable_last(50);

Error malformed(const std::string& why) {
  return fail(ErrorCode::invalid_input, "the request " + why);
}

// Text that is logged must not look like another line of the log.
bool has_control_characters(const std::string& text) {
  return std::ranges::any_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

// Checks the form only.
Status check(const goshawk_msgs::msg::ParameterRequest& request) {
  if (request.id() == 0) return malformed("has id 0: count from 1");
  if (request.client().empty() || has_control_characters(request.client())) {
    return malformed("names no client");
  }
  if (request.verb() != verb::VERB_GET && request.verb() != verb::VERB_SET) {
    return malformed("has a verb that is neither VERB_GET nor VERB_SET");
  }
  const auto& list = request.parameters();
  if (list.size() > kMostParameters) return malformed("names too many parameters at once");
  if (request.verb() == verb::VERB_SET && list.empty())
    return malformed("sets nothing: name a parameter");
  for (const Parameter& p : list) {
    if (p.name().empty()) return malformed("holds a parameter without a name");
    if (has_control_characters(p.name() + p.value())) {
      return malformed("holds a control character");
    }
    if (p.name().size() > kLongestName)
      return malformed("has a parameter name longer than 256 bytes");
    if (p.value().size() > kLongestValue) {
      return malformed("has a value longer than 4096 bytes for " + p.name());
    }
  }
  return success();
}

Parameter to_msg(const ParameterDescription& description) {
  Parameter p;
  p.name(description.name);
  p.value(description.value);
  p.type(description.type);
  p.unit(description.unit);
  p.text(description.text);
  p.default_value(description.default_value);
  p.range(description.range);
  p.at_run_time(description.at_run_time);
  return p;
}

}  // namespace

ParameterService::ParameterService(Node& node, std::unique_ptr<LiveParameters> parameters,
                                   MaySet may_set)
    : node_(node),
      parameters_(std::move(parameters)),
      may_set_(std::move(may_set)),
      answers_(node.advertise<Answer>("/parameter_answer", kQos)) {
  node.subscribe<Request>(
      "/parameter_request", kQos,
      [this](const Request& m, const MessageInfo& info) { on_request(m, info.writer); });
}

void ParameterService::on_request(const Request& request, const Participant& asker) {
  if (request.node() != node_.full_name() || request.client().size() > kLongestName) return;
  if (const Answer* before = given_before(request)) return publish(*before);
  Answer a;
  a.id(request.id());
  a.client(request.client());
  a.node(node_.full_name());
  a.verb(request.verb());
  if (const auto listed = answer(request, asker)) {
    a.code(std::string(to_string(ErrorCode::ok)));
    a.parameters(*listed);
  } else {
    a.code(std::string(to_string(listed.code())));
    a.message(listed.error().message);
  }
  a.header().stamp(conversions::to_stamp(node_.now_ns()));
  publish(a);
  if (request.id() == 0) return;  // cannot be told from another
  given_.push_back(std::move(a));
  if (given_.size() > kMostGiven) given_.pop_front();
}

Result<ParameterService::Listed> ParameterService::answer(const Request& request,
                                                          const Participant& asker) {
  if (auto status = check(request); !status) return status.error();
  if (request.verb() == verb::VERB_GET) return get(request);
  if (auto status = may_set_(asker); !status) return status.error();
  return set(request);
}

Result<ParameterService::Listed> ParameterService::get(const Request& request) const {
  Listed all;
  std::vector<std::string> known;
  for (const auto& description : parameters_->list()) {
    all.push_back(to_msg(description));
    known.push_back(description.name);
  }
  if (request.parameters().empty()) return all;
  Listed chosen;
  for (const Parameter& wanted : request.parameters()) {
    const auto found = std::ranges::find(known, wanted.name());
    if (found == known.end()) {
      const std::string near = nearest_name(wanted.name(), known);
      return fail(ErrorCode::invalid_parameter,
                  wanted.name() + ": no such parameter of " + node_.name() +
                      (near.empty() ? "" : "; did you mean " + near + "?"));
    }
    chosen.push_back(all[std::size_t(found - known.begin())]);
  }
  return chosen;
}

Result<ParameterService::Listed> ParameterService::set(const Request& request) {
  ParameterSource wanted;
  for (const Parameter& p : request.parameters()) {
    auto entry = ParameterSource::written(p.value(), "asked by " + request.client());
    if (wanted.entries().contains(p.name())) entry.fault = "is specified twice: remove one of them";
    wanted.set(p.name(), std::move(entry));
  }
  const auto changes = parameters_->set(wanted);
  if (!changes) return changes.error();
  Listed listed;
  for (const auto& description : parameters_->list()) {
    const auto change = std::ranges::find(*changes, description.name, &ParameterChange::name);
    if (change == changes->end()) continue;
    listed.push_back(to_msg(description));
    listed.back().old_value(change->old_value);
  }
  log_changes(request, listed);
  return listed;
}

void ParameterService::log_changes(const Request& request, const Listed& changes) const {
  for (const Parameter& p : changes) {
    if (p.value() == p.old_value()) continue;  // a flood of these must not fill the disk
    node_.log().info("parameter {}: {} -> {} (request {} of {})", p.name(), p.old_value(),
                     p.value(), request.id(), request.client());
  }
}

const ParameterService::Answer* ParameterService::given_before(const Request& request) const {
  const auto found = std::ranges::find_if(given_, [&](const Answer& a) {
    return a.id() == request.id() && a.client() == request.client();
  });
  return found == given_.end() ? nullptr : &*found;
}

void ParameterService::publish(const Answer& answer) {
  if (auto status = answers_.publish(answer); !status) {
    node_.log().warn("{}", status.error().message);
  }
}

}  // namespace goshawk::runtime
