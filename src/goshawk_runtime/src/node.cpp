#include "goshawk/runtime/node.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <fastrtps/types/TypesBase.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fastdds/dds/publisher/DataWriter.hpp>

#include "any_type.hpp"
#include "apply_qos.hpp"
#include "node_impl.hpp"

namespace goshawk::runtime {

using eprosima::fastrtps::types::ReturnCode_t;

namespace {

constexpr double kLongest_s = 1e6;  // longer waits count as for ever
constexpr double kLookAtKept_s = 0.05;

double clamped(double timeout_s) {
  return timeout_s > 0.0 ? std::min(timeout_s, kLongest_s) : 0.0;  // NaN: no wait
}

Steady::duration to_steady(double time_s) {
  return std::chrono::duration_cast<Steady::duration>(
      std::chrono::duration<double>(clamped(time_s)));
}

eprosima::fastrtps::Duration_t to_duration(double time_s) {
  return eprosima::fastrtps::Duration_t(static_cast<long double>(clamped(time_s)));
}

}  // namespace

namespace detail {

class Writer {
 public:
  Writer(Context::Impl& context, const std::string& node, dds::DataWriter* writer,
         dds::TypeSupport type, std::string topic)
      : context_(context), writer_(writer), type_(std::move(type)), topic_(std::move(topic)) {
    context_.ros_graph.add_writer(node, writer_->guid());
  }
  ~Writer() {
    context_.ros_graph.remove(writer_->guid());
    context_.publisher->delete_datawriter(writer_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  Status publish(const void* message) {
    Sample sample{type_.get(), const_cast<void*>(message)};
    if (writer_->write(&sample)) return success();
    return fail(ErrorCode::io_failed, "the middleware did not take a message on " + topic_ +
                                          ": is it too large, or does "
                                          "a reliable reader hold the writer back?");
  }

  bool wait_acknowledged(double timeout_s) {
    return writer_->wait_for_acknowledgments(to_duration(timeout_s)) == ReturnCode_t::RETCODE_OK;
  }

  int matched() const {
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }

 private:
  Context::Impl& context_;
  dds::DataWriter* writer_;
  dds::TypeSupport type_;
  std::string topic_;
};

}  // namespace detail

Status RawPublisher::publish_raw(const void* message) const {
  return writer_->publish(message);
}
int RawPublisher::matched() const {
  return writer_->matched();
}
bool RawPublisher::wait_acknowledged(double timeout_s) const {
  return writer_->wait_acknowledged(timeout_s);
}

void Node::Impl::wait(double timeout_s) {
  // Messages, not waiting, make timers of simulated time due.
  if (!time.on) {
    for (const auto& timer : timers) {
      timeout_s = std::min(timeout_s, double(timer.next_ns - timer_now_ns()) * 1e-9);
    }
  }
  const bool keeps = std::ranges::any_of(subscriptions, [](auto& s) { return !s->kept.empty(); });
  if (keeps) timeout_s = std::min(timeout_s, kLookAtKept_s);
  wait_set.wait(active, to_duration(more ? 0.0 : timeout_s));
}

bool Node::Impl::wait_for_turn(Subscription& s, double timeout_s) {
  auto& condition = s.reader->get_statuscondition();
  if (!condition.get_trigger_value()) turn_wait_set.wait(active, to_duration(timeout_s));
  return condition.get_trigger_value() && !stopping;
}

void Node::Impl::run_due_timers(const Node& node) {
  // By index: a callback may add a timer.
  for (std::size_t i = 0; i < timers.size() && !stopping; ++i) {
    auto& timer = timers[i];
    const std::int64_t now_ns = timer_now_ns();
    if (now_ns < timer.next_ns) continue;
    timer.next_ns += timer.period_ns;
    if (timer.next_ns < now_ns) timer.next_ns = now_ns + timer.period_ns;
    call(node, "a timer", timer.callback);
  }
}

bool Node::Impl::serve(const Node& node) {
  bool any = false;
  more = false;
  // By index: a callback may subscribe.
  for (std::size_t i = 0; i < subscriptions.size() && !stopping; ++i) {
    const int taken = take_some(node, *subscriptions[i]);
    any = any || taken > 0;
    more = more || taken == kMostAtOnce;
  }
  look_at_kept(node);
  for (auto& callback : std::exchange(deferred, {})) {
    if (!stopping) call(node, "deferred work", callback);
  }
  return any;
}

namespace {

std::function<void(const Error&)> log_second_writers(std::shared_ptr<spdlog::logger> log) {
  return [log = std::move(log)](const Error& error) {
    log->warn("{}: {}", to_string(error.code), error.message);
  };
}

}  // namespace

Node::Node(Context& context, std::string name, RosArgs args, std::shared_ptr<const Clock> clock)
    : name_(std::move(name)),
      args_(std::move(args)),
      clock_(std::move(clock)),
      log_(std::make_shared<spdlog::logger>(name_,
                                            std::make_shared<spdlog::sinks::stderr_sink_mt>())),
      impl_(std::make_unique<Impl>(context.impl())) {
  log_->set_pattern("%Y-%m-%d %H:%M:%S.%e [%n] %l: %v");
  log_->set_level(spdlog::level::from_str(args_.log_level));
  log_->flush_on(spdlog::level::info);
  impl_->on_second_writer = log_second_writers(log_);
  impl_->context.ros_graph.enter(full_name());
}

Node::Node(const Node& other, std::unique_ptr<Impl> impl)
    : name_(other.name_),
      args_(other.args_),
      clock_(other.clock_),
      log_(other.log_),
      impl_(std::move(impl)) {
  impl_->on_second_writer = log_second_writers(log_);
  impl_->context.ros_graph.enter(full_name());
}

Node::~Node() {
  impl_->context.ros_graph.leave(full_name());
}

std::unique_ptr<Node> Node::beside() {
  if (impl_->time.takes_turns) throw std::logic_error("Node::beside() in lock step");
  return std::unique_ptr<Node>(new Node(*this, std::make_unique<Impl>(impl_->context)));
}

bool Node::in_lock_step() const {
  return impl_->time.takes_turns;
}

std::int64_t Node::now_ns() const {
  return impl_->time.on ? impl_->time.now_ns : clock_->now_ns();
}

std::int64_t Node::monotonic_ns() const {
  return impl_->time.on ? impl_->time.now_ns : clock_->monotonic_ns();
}

std::uint64_t Node::refused_datagrams() const {
  return impl_->context.refusals->count();
}

std::string Node::last_refusal() const {
  return impl_->context.refusals->last();
}

std::string Node::full_name() const {
  return (args_.node_namespace == "/" ? "" : args_.node_namespace) + "/" + name_;
}

std::shared_ptr<detail::Writer> Node::make_writer(std::string_view topic, const MessageType& type,
                                                  Qos qos) {
  const std::string name = args_.resolve_topic(topic, name_);
  auto* dds_topic = impl_->context.topic(name, type.impl().support);
  dds::DataWriterQos writer_qos;
  auto* publisher = impl_->context.publisher;
  // A profile named like the topic changes its quality of service without compiling.
  if (publisher->get_datawriter_qos_from_profile(name, writer_qos) != ReturnCode_t::RETCODE_OK) {
    writer_qos = dds::DATAWRITER_QOS_DEFAULT;
    apply(qos, writer_qos);
    apply_writer_times(writer_qos);
  }
  auto* writer =
      dds_topic == nullptr ? nullptr : publisher->create_datawriter(dds_topic, writer_qos);
  if (writer == nullptr) {
    throw StartupFault(fail(ErrorCode::io_failed, name_ + " cannot write " + name + " as " +
                                                      type.name() + ": " +
                                                      impl_->context.why_no_endpoint()));
  }
  return std::make_shared<detail::Writer>(impl_->context, full_name(), writer, type.impl().support,
                                          name);
}

void Node::every(double period_s, std::function<void()> callback) {
  if (!(period_s > 0.0) || !std::isfinite(period_s)) {
    throw std::invalid_argument("Node::every: a period must be above 0 s");
  }
  // At least 1 ns: a period of zero would never leave the loop.
  const auto period_ns =
      std::max(std::int64_t{1}, std::chrono::nanoseconds(to_steady(period_s)).count());
  impl_->timers.push_back({period_ns, impl_->timer_now_ns() + period_ns, std::move(callback)});
}

void Node::on_second_writer(std::function<void(const Error&)> callback) {
  impl_->on_second_writer = std::move(callback);
}

void Node::later(std::function<void()> callback) {
  impl_->deferred.push_back(std::move(callback));
}

void Node::serve(std::unique_ptr<LiveParameters> parameters, ParameterSetters setters) {
  // A component may read its parameters twice: the newest ones count.
  if (impl_->parameters != nullptr) return impl_->parameters->replace(std::move(parameters));
  const auto may_set = [this, setters](const Participant& asker) {
    return check_setter(impl_->context, asker, setters);
  };
  impl_->parameters = std::make_unique<ParameterService>(*this, std::move(parameters), may_set);
}

void Node::spin() {
  while (!impl_->stopping) spin_some(kLongest_s);
}

void Node::spin_some(double timeout_s) {
  if (impl_->time.takes_turns) return impl_->follow(*this, timeout_s);
  if (!impl_->time.followers.empty()) return impl_->lead(*this);
  impl_->wait(clamped(timeout_s));
  if (impl_->stopping) return;
  impl_->run_due_timers(*this);
  impl_->serve(*this);
}

void Node::stop() {
  impl_->stopping = true;
  impl_->stop.set_trigger_value(true);
}

}  // namespace goshawk::runtime
