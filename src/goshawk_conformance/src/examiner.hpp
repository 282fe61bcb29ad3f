#pragma once

#include <algorithm>
#include <cstdio>
#include <optional>

#include "cases.hpp"
#include "goshawk/conformance/conform.hpp"
#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/runtime/node.hpp"
#include "recorded.hpp"
#include "tally.hpp"

namespace goshawk::conformance {

/// Sends Inputs to a stage, and examines the Outputs and the reports that come back.
template <typename Input, typename Output>
class Examiner {
 public:
  Examiner(runtime::Context& context, const Options& options, const char* input_topic,
           const char* output_topic, const World& world)
      : options_(options),
        node_(context, "goshawk_conform", in_namespace(options.node_namespace)),
        world_(world),
        input_topic_(input_topic),
        maps_(node_.advertise<msg::VoxelGrid>("map/voxels", runtime::Qos::latched())),
        inputs_(node_.advertise<Input>(input_topic, runtime::Qos::reliable_last())) {
    node_.subscribe<Output>(output_topic, runtime::Qos::reliable_last(100),
                            [this](const Output& m, const runtime::MessageInfo& info) {
                              answer_.outputs.push_back(m);
                              answer_.arrived_ns = info.received_ns;
                            });
    node_.subscribe<msg::StageReport>("stage_report", runtime::Qos::latched(1000),
                                      [this](const msg::StageReport& m, const auto&) { take(m); });
  }

  Result<Report> examine(const Cases<Input>& cases,
                         const std::optional<Recorded<Input>>& recorded) {
    if (auto there = wait_for_stage(); !there) return there.error();
    report_.stage = options_.stage;
    report_.items.push_back({"reports that it is ready", ready_,
                             ready_ ? "" : "no stage_report of request 0 with code ok came"});
    if (!cases.no_map.empty() && options_.fresh) examine_no_map(cases);
    send_map(*world_.grid);
    meet(cases.good.front().input);
    examine_good(cases);
    for (const auto& bad : cases.bad) examine_bad(bad);
    examine_garbage(cases.good.front().input);
    if (recorded) examine_recorded(*recorded);
    report_.implementation = implementation_;
    return report_;
  }

 private:
  struct Answer {
    std::vector<Output> outputs;
    std::vector<msg::StageReport> reports;
    std::int64_t sent_ns = 0, arrived_ns = 0;
  };

  void take(const msg::StageReport& m) {
    if (conversions::stage_role_of(m.stage()) != stage_role_of(options_.stage)) return;
    implementation_ = m.implementation();
    if (m.request_id() == 0 && m.code() == "ok") ready_ = true;
    if (m.request_id() == id_) answer_.reports.push_back(m);
  }

  template <typename Done>
  bool spin_until(double timeout_s, const Done& done) {
    const std::int64_t end_ns = node_.now_ns() + std::int64_t(timeout_s * 1e9);
    while (!done() && node_.now_ns() < end_ns) node_.spin_some(0.02);
    return done();
  }

  Status wait_for_stage() {
    const bool there = spin_until(options_.ready_timeout_s, [&] { return inputs_.matched() > 0; });
    if (!there) {
      return fail(ErrorCode::stage_silent, "no node reads " + std::string(input_topic_) + ": is " +
                                               options_.stage +
                                               " running, in this domain and namespace?");
    }
    spin_until(2.0, [&] { return ready_; });
    spin_until(0.5, [] { return false; });  // the writers of its answers are found as well
    return success();
  }

  /// On a busy machine the stage's writer may not have found our reader yet. Only an answer shows
  /// that it has.
  void meet(const Input& good) {
    constexpr int kMost = 4;
    Input sent;
    for (int k = 0; k < kMost && ask(good, sent).outputs.empty(); ++k) continue;
  }

  void send_map(const VoxelGrid& grid) {
    msg::VoxelGrid m;
    conversions::fill_msg(grid, m);
    m.header(conversions::make_header(node_.now_ns()));
    (void)maps_.publish(m);
    maps_.wait_acknowledged(2.0);
    spin_until(0.3, [] { return false; });
  }

  Input stamped(Input input) {
    auto& request = request_of(input);
    request.id(id_);
    if (conversions::to_ns(request.header().stamp()) == 0) {
      request.header().stamp(conversions::to_stamp(node_.now_ns()));
    }
    if constexpr (!std::is_same_v<Input, msg::PlanRequest>) {
      input.header().stamp(conversions::to_stamp(node_.now_ns()));
    }
    return input;
  }

  /// The answer: a result with its report, or a report of failure; or whatever came until timeout.
  Answer ask(const Input& input, Input& sent) {
    ++id_;
    answer_ = {};
    sent = stamped(input);
    answer_.sent_ns = node_.now_ns();
    (void)inputs_.publish(sent);
    spin_until(options_.timeout_s, [&] {
      const bool failed = !answer_.reports.empty() && answer_.reports.back().code() != "ok";
      return failed || (!answer_.reports.empty() && !answer_.outputs.empty());
    });
    node_.spin_some(0.002);  // an extra answer would follow at once
    return answer_;
  }

  void examine_no_map(const Cases<Input>& cases) {
    Input sent;
    const Answer answer = ask(cases.good.front().input, sent);
    report_.items.push_back(code_item("a request before any map", answer, {cases.no_map}));
  }

  void examine_good(const Cases<Input>& cases) {
    Tally answered("answers every request"), reported("reports every result"),
        echoed("echoes the request whole"), valid("results are valid"),
        again("gives the same answer twice");
    std::vector<double> latencies_s;
    for (std::size_t k = 0; k < cases.good.size(); ++k) {
      Input sent;
      const Answer answer = ask(cases.good[k].input, sent);
      const std::string name = fmt::format("request {}", id_);
      answered.check(answer.outputs.size() == 1, name + what_came(answer));
      if (answer.outputs.size() != 1) continue;
      const Output& output = answer.outputs.front();
      latencies_s.push_back(double(answer.arrived_ns - answer.sent_ns) * 1e-9);
      reported.check(answer.reports.size() == 1 && answer.reports.front().code() == "ok",
                     name + what_came(answer));
      echoed.check(runtime::encode(output.request()) == runtime::encode(request_of(sent)),
                   name + " came back changed");
      const std::string fault = fault_of(output, sent, *world_.grid);
      valid.check(fault.empty(), name + ": " + fault);
      if (k % 8 == 0) check_again(cases.good[k].input, output, again);
    }
    for (const Tally* t : {&answered, &reported, &echoed, &valid, &again}) {
      report_.items.push_back(t->item());
    }
    add_latency(report_, std::move(latencies_s));
  }

  void check_again(const Input& input, const Output& first, Tally& again) {
    Input sent;
    const Answer answer = ask(input, sent);
    if (answer.outputs.size() != 1)
      return again.check(false, "the second time" + what_came(answer));
    const auto bare = [](Output m) {  // without fields that may differ
      m.header({});
      m.request({});
      m.compute_ns(0);
      return runtime::encode(m);
    };
    again.check(bare(answer.outputs.front()) == bare(first),
                fmt::format("request {}", id_) + " had another answer before");
  }

  std::string what_came(const Answer& answer) const {
    if (answer.outputs.empty() && answer.reports.empty()) {
      return fmt::format(" had no answer within {:g} s (--timeout)", options_.timeout_s);
    }
    std::string text =
        fmt::format(" had {} results and {} reports", answer.outputs.size(), answer.reports.size());
    if (!answer.reports.empty()) {
      text += " (" + answer.reports.back().code() + ": " + answer.reports.back().message() + ")";
    }
    return text;
  }

  Item code_item(const std::string& name, const Answer& answer,
                 const std::set<std::string>& codes) const {
    std::string wanted;
    for (const auto& code : codes) wanted += (wanted.empty() ? "" : " or ") + code;
    Item item{"refuses " + name, false, "must be " + wanted + ", but it" + what_came(answer)};
    if (answer.reports.size() != 1 || !answer.outputs.empty()) return item;
    const auto& report = answer.reports.front();
    if (!codes.contains(report.code())) return item;
    if (report.message().empty()) {
      item.detail = report.code() + " came without a sentence";
      return item;
    }
    return {item.name, true, report.code()};
  }

  void examine_bad(const Case<Input>& bad) {
    Input sent;
    const Answer answer = ask(bad.input, sent);
    report_.items.push_back(code_item(bad.name, answer, bad.codes));
  }

  // Recorded requests in their recorded map. A failure is an answer too, if there was no result.
  void examine_recorded(const Recorded<Input>& recorded) {
    send_map(*recorded.grid);
    Tally answered("answers every recorded request"), solved("solves what was solved before"),
        echoed("echoes recorded requests whole"), valid("results of recorded requests are valid");
    for (Input input : recorded.inputs) {
      const std::uint64_t recorded_id = request_of(input).id();
      request_of(input).header().stamp({});  // stamped anew, so that deadlines have not passed
      Input sent;
      const Answer answer = ask(input, sent);
      const std::string name = fmt::format("recorded request {}", recorded_id);
      const bool refused = answer.outputs.empty() && answer.reports.size() == 1 &&
                           answer.reports.front().code() != "ok" &&
                           !answer.reports.front().message().empty();
      const bool has_result = answer.outputs.size() == 1;
      answered.check(has_result || refused, name + what_came(answer));
      if (recorded.solved.contains(recorded_id)) solved.check(has_result, name + what_came(answer));
      if (!has_result) continue;
      const Output& output = answer.outputs.front();
      echoed.check(runtime::encode(output.request()) == runtime::encode(request_of(sent)),
                   name + " came back changed");
      const std::string fault = fault_of(output, sent, *recorded.grid);
      valid.check(fault.empty(), name + ": " + fault);
    }
    for (const Tally* t : {&answered, &solved, &echoed, &valid}) {
      if (t->checked() > 0) report_.items.push_back(t->item());
    }
  }

  // Bytes that are not a message, from a second writer; then a good request.
  void examine_garbage(const Input& good) {
    const auto raw = node_.advertise_raw(
        input_topic_, runtime::raw_message_type(runtime::message_type<Input>().name()),
        runtime::Qos::reliable_last());
    spin_until(1.0, [&] { return raw.matched() > 0; });
    Random random(options_.seed);
    for (int k = 0; k < 10; ++k) {
      std::vector<unsigned char> bytes = {0, 1, 0, 0};
      for (int n = random.below(600); n > 0; --n)
        bytes.push_back((unsigned char)(random.below(256)));
      (void)raw.publish_raw(&bytes);
    }
    spin_until(0.2, [] { return false; });
    Input sent;
    const Answer answer = ask(good, sent);
    report_.items.push_back(
        {"survives garbage", answer.outputs.size() == 1,
         answer.outputs.size() == 1 ? "" : "a good request" + what_came(answer)});
  }

  const Options& options_;
  runtime::Node node_;
  const World& world_;
  const char* input_topic_;
  runtime::Publisher<msg::VoxelGrid> maps_;
  runtime::Publisher<Input> inputs_;
  Report report_;
  Answer answer_;
  std::uint64_t id_ = 1000;
  std::string implementation_;
  bool ready_ = false;
};

}  // namespace goshawk::conformance
