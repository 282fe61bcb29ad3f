// bench stage STAGE --input RECORDING: feeds a stage with recorded inputs over DDS, ours in a
// process, ours in this one, and another one's, and tells computing from the wire.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>

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
  if (!reader) {
    std::fprintf(stderr, "goshawk bench stage: %s\n", reader.error().message.c_str());
    return 1;
  }
  const std::string& stage = feed_options.stage;
  const auto folder = std::filesystem::path(this_program()).parent_path();
  std::string ours = "'" + (folder / "../../bin/goshawk_container").string() + "' " + stage;
  if (stage == "map_server") ours += " --ros-args -p use_box:=true";
  std::vector<std::pair<std::string, std::string>> implementations = {
      {stage, ours}, {stage + ", in one process", ""}};
  if (!against.empty()) implementations.emplace_back(against, against);
  Report report("stage", options);
  auto curves = nlohmann::ordered_json::array();
  std::string failure;
  for (const auto& [name, command] : implementations) {
    report.progress(name);
    const auto samples = feed(feed_options, command, *reader);
    if (!samples) {
      failure = samples.error().message;
      break;
    }
    add_rows(report, curves, name, *samples);
  }
  report.note("curves", curves);
  draw(report, stage);
  // What was measured before is worth its time.
  const int status = curves.empty() ? 1 : report.finish();
  if (failure.empty()) return status;
  std::fprintf(stderr, "goshawk bench stage: %s\n", failure.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "A stage fed from a recording, over DDS and in one process: computing, transport, loss.",
      "goshawk bench stage");
  FeedOptions feed_options;
  Options options;
  std::string against;
  app.add_option("stage", feed_options.stage)->required()->check(CLI::IsMember(fed_stages()));
  app.add_option("--input", feed_options.input, "an MCAP recording with the stage's inputs")
      ->required();
  app.add_option("--against", against, "command of another implementation, beside ours");
  app.add_option("-n,--count", feed_options.count, "requests")
      ->capture_default_str()
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--rate", feed_options.rate_hz,
                 "[Hz] whether answered or not; 0: the next when the last is answered")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1e5));
  app.add_option("--plots", options.plots, "folder for pictures and the report as JSON");
  app.add_flag("--quick", options.quick, "less of everything");
  app.add_flag("--json", options.json, "one JSON object");
  CLI11_PARSE(app, argc, argv);
  if (options.quick) feed_options.count = std::min(feed_options.count, 50);
  try {
    feed_options.domain = goshawk::runtime::hold_private_domain().value();
    return run(feed_options, against, options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "goshawk bench stage: %s\n", e.what());
    return 1;
  }
}
