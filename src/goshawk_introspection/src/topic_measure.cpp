#include <cstring>
#include <iostream>
#include <optional>

#include "goshawk/introspection/schema.hpp"
#include "statistics.hpp"
#include "text.hpp"
#include "topic_reader.hpp"
#include "topic_verbs.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;

struct MeasureOptions {
  ReadOptions read;
  int window = 10000;
};

void print(const Json& report, const std::string& sentence, bool as_json) {
  std::cout << (as_json ? to_line(report) : sentence) << std::endl;
}

std::string format(const char* pattern, auto... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, pattern, values...);
  return buffer;
}

// Both a report a second and one at the end, unless nothing was measured.
template <typename Add, typename Report>
int measure(
    const CommonOptions& common, const MeasureOptions& options, const Add& add,
    const Report& report,
    const std::function<int(const std::string&)>& begin = [](const auto&) { return 0; }) {
  bool any = false;
  const int status = read_topic(
      common, options.read, begin,
      [&](const RawMessage& message) {
        any = true;
        add(message);
        return true;
      },
      report);
  if (any) report();
  return status;
}

int hz(const CommonOptions& common, const MeasureOptions& options) {
  Window periods(std::size_t(options.window));
  std::optional<std::int64_t> last_ns;
  return measure(
      common, options,
      [&](const RawMessage& message) {
        if (last_ns) periods.add(double(message.received_ns - *last_ns) * 1e-9);
        last_ns = message.received_ns;
      },
      [&] {
        if (periods.empty() || !(periods.mean() > 0.0)) return;
        const double rate = 1.0 / periods.mean();
        print({{"rate_hz", rate},
               {"min_s", periods.min()},
               {"max_s", periods.max()},
               {"deviation_s", periods.deviation()},
               {"window", periods.size() + 1}},
              format("average rate: %.3f Hz  min: %.6f s  max: %.6f s  deviation: %.6f s  "
                     "window: %zu",
                     rate, periods.min(), periods.max(), periods.deviation(), periods.size() + 1),
              common.json);
      });
}

// The header is the first field, and its stamp the first of the header: 4 + 4 bytes behind the
// encapsulation.
std::optional<double> stamp_s(const std::vector<unsigned char>& bytes) {
  if (bytes.size() < 12 || bytes[1] > 1) return std::nullopt;
  std::uint32_t words[2];
  std::memcpy(words, bytes.data() + 4, sizeof words);
  if (bytes[1] == 0) {
    for (auto& word : words) word = __builtin_bswap32(word);
  }
  return double(std::int32_t(words[0])) + double(words[1]) * 1e-9;
}

int delay(const CommonOptions& common, const MeasureOptions& options) {
  Window delays(std::size_t(options.window));
  const auto has_header = [](const std::string& name) {
    auto type = find_type(name);
    if (!type) return say_wrong_call(type.error().message);
    const Field& first = (*type)->fields.front();
    if (first.kind == Kind::structure && first.arity == Arity::single &&
        all_types()[std::size_t(first.type)].name == "std_msgs/msg/Header") {
      return 0;
    }
    return say_wrong_call(name + " has no header, so no stamp to measure from; hz works");
  };
  return measure(
      common, options,
      [&](const RawMessage& message) {
        if (const auto stamp = stamp_s(message.bytes)) {
          delays.add(double(message.received_ns) * 1e-9 - *stamp);
        }
      },
      [&] {
        if (delays.empty()) return;
        print({{"mean_s", delays.mean()},
               {"min_s", delays.min()},
               {"max_s", delays.max()},
               {"deviation_s", delays.deviation()},
               {"window", delays.size()}},
              format("average delay: %.6f s  min: %.6f s  max: %.6f s  deviation: %.6f s  "
                     "window: %zu",
                     delays.mean(), delays.min(), delays.max(), delays.deviation(), delays.size()),
              common.json);
      },
      has_header);
}

int bw(const CommonOptions& common, const MeasureOptions& options) {
  Window sizes(std::size_t(options.window));
  Window times(std::size_t(options.window));
  return measure(
      common, options,
      [&](const RawMessage& message) {
        sizes.add(double(message.bytes.size()));
        times.add(double(message.received_ns) * 1e-9);
      },
      [&] {
        // n messages span n - 1 periods.
        const double span_s = times.empty() ? 0.0 : times.back() - times.front();
        const double rate = span_s > 0.0 ? (sizes.sum() - sizes.front()) / span_s : 0.0;
        if (sizes.empty()) return;
        print({{"bytes_per_s", rate},
               {"mean_bytes", sizes.mean()},
               {"min_bytes", sizes.min()},
               {"max_bytes", sizes.max()},
               {"window", sizes.size()}},
              format("%.1f KB/s from %zu messages  mean: %.0f B  min: %.0f B  max: %.0f B",
                     rate / 1e3, sizes.size(), sizes.mean(), sizes.min(), sizes.max()),
              common.json);
      });
}

Verb measure_verb(const char* name, const char* summary,
                  int (*run)(const CommonOptions&, const MeasureOptions&)) {
  return {name, summary, [run, name](CLI::App& app, CommonOptions& common) {
            auto options = std::make_shared<MeasureOptions>();
            app.add_option("topic", options->read.topic, "its name")->required();
            app.add_option("-w,--window", options->window, "newest messages that count")
                ->check(CLI::Range(2, 10'000'000))
                ->capture_default_str();
            app.add_option("-n", options->read.count, "that many messages, then end")
                ->check(CLI::Range(1, 1'000'000'000));
            app.footer("Example:\n  goshawk topic " + std::string(name) + " /odom -n 500");
            return [&common, options, run] { return run(common, *options); };
          }};
}

}  // namespace

Verb topic_hz_verb() {
  return measure_verb("hz", "rate at which messages come", hz);
}
Verb topic_delay_verb() {
  return measure_verb("delay", "time from the header's stamp to the arrival here", delay);
}
Verb topic_bw_verb() {
  return measure_verb("bw", "bytes a second", bw);
}

}  // namespace goshawk::introspection
