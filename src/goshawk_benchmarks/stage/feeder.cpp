#include "stage/feeder.hpp"

#include <map>
#include <optional>
#include <thread>

#include "common/child.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/recording/messages.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/runtime/node.hpp"

namespace goshawk::bench {
namespace {

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;

constexpr double kMeet_s = 20.0, kSettle_s = 1.0;
constexpr int kWarm = 10;

msg::PlanRequest& request_of(msg::PlanRequest& m) {
  return m;
}
template <typename Message>
msg::PlanRequest& request_of(Message& m) {
  return m.request();
}

/// What is measured: a program, or our component with a node and a thread as in the container.
class Stage {
 public:
  static Result<std::unique_ptr<Stage>> start(const FeedOptions& options, Context& context,
                                              const std::string& command) {
    auto stage = std::unique_ptr<Stage>(new Stage);
    if (!command.empty()) {
      stage->child_.emplace(std::vector<std::string>{"/bin/sh", "-c", "exec " + command},
                            options.domain);
      return stage;
    }
    const auto component = load_component(options.stage);
    if (!component) return component.error();
    RosArgs args;
    args.log_level = "error";
    stage->node_ = std::make_unique<Node>(context, options.stage, args);
    stage->component_ = (*component)->create(*stage->node_);
    stage->thread_ = std::thread([node = stage->node_.get()] { node->spin(); });
    return stage;
  }
  ~Stage() {
    if (node_ != nullptr) node_->stop();
    if (thread_.joinable()) thread_.join();
    component_.reset();
  }

 private:
  Stage() = default;
  std::optional<Child> child_;
  std::unique_ptr<Node> node_;
  std::unique_ptr<Component> component_;
  std::thread thread_;
};

/// Sends the requests and collects the answers.
template <typename Input, typename Output>
class Feeder {
 public:
  Feeder(const FeedOptions& options, Context& context, const std::string& in,
         const std::string& out)
      : options_(options),
        node_(context, "goshawk_bench_stage"),
        maps_(node_.advertise<msg::VoxelGrid>("map/voxels", Qos::latched())),
        inputs_(node_.advertise<Input>(in, Qos::reliable_last())) {
    node_.subscribe<Output>(
        out, Qos::reliable_last(100),
        [this](const Output& m, const MessageInfo& info) { on_answer(m, info.received_ns); });
    node_.subscribe<msg::StageReport>("stage_report", Qos::latched(100),
                                      [this](const msg::StageReport& m, const auto&) {
                                        if (m.code() == "ok" || !open_.erase(m.request_id()))
                                          return;
                                        ++samples_.refused;
                                      });
  }

  /// @return whether somebody reads the inputs
  bool meet() {
    return wait(kMeet_s, [&] { return inputs_.matched() > 0; });
  }

  /// @param map or nullptr
  Result<FeedSamples> feed(const std::vector<Input>& inputs, const msg::VoxelGrid* map) {
    if (map != nullptr) (void)maps_.publish(*map);
    wait(kSettle_s, [] { return false; });
    std::int64_t begin_ns = 0;
    for (int k = 0; k < options_.count + kWarm; ++k) {
      if (k == kWarm) {  // what came before did not count
        samples_ = {};
        open_.clear();
        begin_ns = node_.now_ns();
      }
      if (auto status = send(inputs[std::size_t(k) % inputs.size()]); !status) {
        return status.error();
      }
      if (options_.rate_hz <= 0.0 || k < kWarm) {
        wait(options_.timeout_s, [&] { return open_.empty(); });
      } else {
        const double due_s = double(k - kWarm + 1) / options_.rate_hz;
        wait(due_s - 1e-9 * double(node_.now_ns() - begin_ns), [] { return false; });
      }
      samples_.elapsed_s = 1e-9 * double(node_.now_ns() - begin_ns);
    }
    wait(options_.timeout_s, [&] { return open_.empty(); });
    samples_.lost = int(open_.size());
    return samples_;
  }

 private:
  template <typename Done>
  bool wait(double seconds, const Done& done) {
    const auto end_ns = node_.now_ns() + std::int64_t(1e9 * seconds);
    for (auto left_ns = end_ns - node_.now_ns(); !done() && left_ns > 0;
         left_ns = end_ns - node_.now_ns()) {
      node_.spin_some(std::min(0.02, 1e-9 * double(left_ns)));
    }
    return done();
  }

  Status send(Input input) {
    const std::int64_t now_ns = node_.now_ns();
    request_of(input).id(++id_);
    request_of(input).header().stamp(conversions::to_stamp(now_ns));
    input.header().stamp(conversions::to_stamp(now_ns));
    open_[id_] = now_ns;
    ++samples_.sent;
    return inputs_.publish(input);
  }

  void on_answer(const Output& m, std::int64_t received_ns) {
    const auto asked = open_.find(m.request().id());
    if (asked == open_.end()) return;
    const double total_us = 1e-3 * double(received_ns - asked->second);
    samples_.total_us.push_back(total_us);
    samples_.compute_us.push_back(1e-3 * double(m.compute_ns()));
    samples_.wire_us.push_back(total_us - samples_.compute_us.back());
    open_.erase(asked);
  }

  const FeedOptions& options_;
  Node node_;
  Publisher<msg::VoxelGrid> maps_;
  Publisher<Input> inputs_;
  FeedSamples samples_;
  std::map<std::uint64_t, std::int64_t> open_;  // unanswered requests, and when they were sent
  std::uint64_t id_ = 0;
};

template <typename Input, typename Output>
Result<FeedSamples> feed(const FeedOptions& options, const std::string& command,
                         recording::Reader& reader, const std::string& in, const std::string& out) {
  const auto inputs = recording::messages_of<Input>(reader, in);
  if (!inputs) return inputs.error();
  // A stage without a map gets along without.
  const auto maps = recording::messages_of<msg::VoxelGrid>(reader, "map/voxels");
  ContextOptions context_options;
  context_options.domain = options.domain;
  auto context = Context::create(context_options);
  if (!context) return context.error();
  const auto stage = Stage::start(options, **context, command);
  if (!stage) return stage.error();
  Feeder<Input, Output> feeder(options, **context, in, out);
  if (!feeder.meet()) {
    return fail(ErrorCode::stage_silent, "nobody reads " + in + ": does '" + command + "' run?");
  }
  return feeder.feed(*inputs, maps ? &maps->back() : nullptr);
}

}  // namespace

std::vector<std::string> fed_stages() {
  return {"path_search", "corridor_builder", "trajectory_optimizer"};
}

Result<FeedSamples> feed(const FeedOptions& o, const std::string& command,
                         recording::Reader& reader) {
  if (o.stage == "path_search") {
    return feed<msg::PlanRequest, msg::Path>(o, command, reader, "plan_request", "path");
  }
  if (o.stage == "corridor_builder") {
    return feed<msg::Path, msg::Corridor>(o, command, reader, "path", "corridor");
  }
  return feed<msg::Corridor, msg::BezierTrajectory>(o, command, reader, "corridor", "trajectory");
}

}  // namespace goshawk::bench
