// goshawk bench stage: feeds a stage with recorded inputs over DDS, ours in a
// process, ours in this one, and another one's, and tells computing from the wire.

#include <algorithm>
#include <filesystem>
#include <optional>

#include "common/child.hpp"
#include "common/measure.hpp"
#include "common/report.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "stage/feeder.hpp"

namespace {

using namespace goshawk;
using namespace goshawk::bench;

constexpr int kCurve = 50;  // points of a picture's line

void add_rows(Report& report, nlohmann::ordered_json& curves, const std::string& name,
              FeedSamples s) {
  for (const auto& [part, values] :
       {std::pair{"compute", &s.compute_us}, std::pair{"transport", &s.wire_us},
        std::pair{"total", &s.total_us}}) {
    if (values->empty() && !s.total_us.empty()) continue;  // answers that do not tell it
    std::ranges::sort(*values);
    report.add({{"table", "latency [us]"},
                {"implementation", name},
                {"part", part},
                {"p50_us", at_share(*values, 0.5)},
                {"p90_us", at_share(*values, 0.9)},
                {"p99_us", at_share(*values, 0.99)},
                {"max_us", at_share(*values, 1.0)}});
    for (int k = 0; k <= kCurve; ++k) {
      const double share = double(k) / kCurve;
      curves.push_back({{"line", name + ", " + part},
                        {"part", part},
                        {"percent", 100.0 * share},
                        {"us", at_share(*values, share)}});
    }
  }
  const int answered = int(s.total_us.size());
  report.add({{"table", "requests"},
              {"implementation", name},
              {"sent", s.sent},
              {"answered", answered},
              {"refused", s.refused},
              {"lost", s.lost},
              {"answers_per_s", s.elapsed_s > 0.0 ? (answered + s.refused) / s.elapsed_s : 0.0}});
}

void draw(Report& report, const std::string& stage) {
  for (const char* part : {"total", "transport", "compute"}) {
    report.draw({.file = "stage_" + stage + "_" + part,
                 .title = stage + ", " + part + " latency on recorded requests",
                 .x = "percent",
                 .y = "us",
                 .x_label = "share of the answers [%]",
                 .y_label = "not longer than [us]",
                 .series = "line",
                 .where = {{"part", part}},
                 .log_y = true,
                 .from = "curves"});
  }
}

int run(FeedOptions feed_options, const std::string& against, const Options& options) {
  auto reader = recording::Reader::open(feed_options.input);
  if (!reader) return report_failure("stage", options.json, reader.error());
  const std::string& stage = feed_options.stage;
  const auto folder = std::filesystem::path(this_program()).parent_path();
  std::string ours = "'" + (folder / "../../bin/goshawk_container").string() + "' " + stage;
  if (stage == "map_server") ours += " --ros-args -p use_box:=true";
  std::vector<std::pair<std::string, std::string>> implementations = {
      {stage, ours}, {stage + ", in one process", ""}};
  if (!against.empty()) implementations.emplace_back(against, against);
  Report report("stage", options);
  auto curves = nlohmann::ordered_json::array();
  std::optional<Error> failure;
  for (const auto& [name, command] : implementations) {
    report.progress(name);
    const auto samples = feed(feed_options, command, *reader);
    if (!samples) {
      failure = samples.error();
      break;
    }
    add_rows(report, curves, name, *samples);
  }
  report.note("curves", curves);
  draw(report, stage);
  if (!failure) return report.finish();
  // What was measured before is worth its time.
  if (curves.empty()) return report_failure("stage", options.json, *failure);
  report.finish();
  return report_failure("stage", false, *failure);
}

}  // namespace

int main(int argc, char** argv) {
  return bench_call(argc, argv, "stage", [](const Call& call) {
    const Options options = Options::of(call);
    FeedOptions feed_options;
    feed_options.stage = call.at("stage");
    feed_options.input = call.at("input");
    feed_options.count = call.at("count");
    feed_options.rate_hz = call.at("rate_hz");
    if (options.quick) feed_options.count = std::min(feed_options.count, 50);
    feed_options.domain = goshawk::runtime::hold_private_domain().value();
    return run(feed_options, call.at("against"), options);
  });
}
