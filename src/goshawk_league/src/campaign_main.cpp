// Many live flights, each through a world of its own that the vehicle does not know.
#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <vector>

#include "goshawk/league/live_case.hpp"
#include "goshawk/league/settings.hpp"

namespace goshawk::league {
namespace {

using nlohmann::json;

constexpr char kUsage[] =
    "usage: goshawk_live_campaign [--flights N] [--first N] [--jobs N] [--seconds S] [--file "
    "FILE]\n"
    "           [--latency SECONDS] [--vehicle FILE] [--json]\n"
    "Flies the flights FIRST to FIRST + N - 1 and adds a line of JSON for each to FILE; what is "
    "in\n"
    "FILE already is not flown again. Begins no flight after S seconds. Ends with status 1 if a\n"
    "flight touched something.\n";

struct Arguments {
  std::uint64_t flights = 100, first = 0;
  unsigned jobs = 1;
  double seconds = 1e9;
  double latency_s = 0.005;
  std::string file = "live_campaign.jsonl";
  std::filesystem::path vehicle_file;
  bool json = false;
};

template <typename Number>
bool read(const std::string& text, Number& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size();
}

bool set(const std::string& option, const std::string& value, Arguments& a) {
  if (option == "--flights") return read(value, a.flights) && a.flights <= 1'000'000;
  if (option == "--first") return read(value, a.first) && a.first <= 1'000'000'000;
  if (option == "--jobs") return read(value, a.jobs) && a.jobs >= 1 && a.jobs <= 256;
  if (option == "--seconds") return read(value, a.seconds) && a.seconds > 0.0;
  if (option == "--latency") {
    return read(value, a.latency_s) && a.latency_s >= 0.0 && a.latency_s <= 10.0;
  }
  if (option == "--file") a.file = value;
  if (option == "--vehicle") a.vehicle_file = value;
  return (option == "--file" || option == "--vehicle") && !value.empty();
}

Result<Arguments> parse(int argc, char** argv) {
  Arguments a;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--json") {
      a.json = true;
    } else if (i + 1 >= argc || !set(word, argv[i + 1], a)) {
      return fail(ErrorCode::invalid_parameter,
                  fmt::format("'{} {}' is no option with a valid value", word,
                              i + 1 < argc ? argv[i + 1] : ""));
    } else {
      ++i;
    }
  }
  if (a.vehicle_file.empty()) {
    const auto here = std::filesystem::weakly_canonical(argv[0]).parent_path();
    a.vehicle_file = here / "../../share/goshawk/config/racer.yaml";
  }
  return a;
}

json to_json(const LiveCase& live, bool reachable, const Outcome& o) {
  const std::size_t kept = std::min<std::size_t>(o.events.size(), 8);
  return {{"number", live.number},
          {"kind", live.kind},
          {"density", live.density},
          {"v_max_m_s", live.scene.limits.v_max_m_s},
          {"range_m", live.options.range_m},
          {"noise_m", live.options.range_noise_m},
          {"view_rad", live.options.view_rad},
          {"reachable", reachable},
          {"arrived", o.arrived},
          {"touched", o.verdict.touched},
          {"code", std::string(to_string(o.code))},
          {"reason", o.reason},
          {"time_s", o.time_s},
          {"clearance_m", o.verdict.clearance_m},
          {"max_error_m", o.max_error_m},
          {"stops", o.stops},
          {"last_events",
           std::vector<std::string>(o.events.end() - std::ptrdiff_t(kept), o.events.end())}};
}

/// A flight that cannot be made is no failure of the vehicle's; its line says why.
json fly_one(std::uint64_t number, const closed_loop::Setup& vehicle, double latency_s) {
  auto live = make_live_case(number, vehicle);
  if (!live) return {{"number", number}, {"not_flown", live.error().message}};
  live->options.latency_s = latency_s;
  const auto reachable = can_be_reached(live->scene);
  if (!reachable) return {{"number", number}, {"not_flown", reachable.error().message}};
  const auto outcome = fly(live->scene, live->options);
  if (!outcome) return {{"number", number}, {"not_flown", outcome.error().message}};
  return to_json(*live, *reachable, *outcome);
}

bool is_result(const json& r) {
  const auto has = [&r](const char* key, auto is) { return r.contains(key) && (r[key].*is)(); };
  if (!r.is_object() || !has("number", &json::is_number_unsigned)) return false;
  return r.contains("not_flown") ||
         (has("reachable", &json::is_boolean) && has("arrived", &json::is_boolean) &&
          has("touched", &json::is_boolean) && has("code", &json::is_string) &&
          r.contains("max_error_m") && r.contains("clearance_m"));
}

/// What the file has; a line that was cut off, or is no result, is flown again.
std::map<std::uint64_t, json> flown_before(const std::string& file) {
  std::map<std::uint64_t, json> flown;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    json result = json::parse(line, nullptr, false);
    if (!is_result(result)) continue;
    const auto number = result["number"].get<std::uint64_t>();
    flown[number] = std::move(result);
  }
  return flown;
}

json summary_of(const Arguments& a, const std::map<std::uint64_t, json>& flown) {
  int flights = 0, not_flown = 0, reachable = 0, arrived = 0, arrived_reachable = 0, contacts = 0;
  double error_m = 0.0, clearance_m = 1e9;
  std::map<std::string, std::vector<std::uint64_t>> failed;
  for (auto at = flown.lower_bound(a.first); at != flown.end() && at->first < a.first + a.flights;
       ++at) {
    const json& r = at->second;
    if (r.contains("not_flown")) {
      ++not_flown;
      continue;
    }
    ++flights;
    const bool there = r["arrived"], can = r["reachable"], touched = r["touched"];
    reachable += int(can);
    arrived += int(there);
    arrived_reachable += int(there && can);
    contacts += int(touched);
    // JSON has no infinity: a flight that came near nothing has no clearance.
    if (r["max_error_m"].is_number()) error_m = std::max(error_m, r["max_error_m"].get<double>());
    if (r["clearance_m"].is_number()) {
      clearance_m = std::min(clearance_m, r["clearance_m"].get<double>());
    }
    if (!there && can) failed[r["code"]].push_back(at->first);
  }
  return {{"flights", flights},
          {"not_flown", not_flown},
          {"reachable", reachable},
          {"arrived", arrived},
          {"arrived_of_reachable", arrived_reachable},
          {"contacts", contacts},
          {"failed_by_code", failed},
          {"max_error_m", flights > 0 ? json(error_m) : json()},
          {"min_clearance_m", flights > 0 ? json(clearance_m) : json()}};
}

int fly_all(const Arguments& a, const closed_loop::Setup& vehicle) {
  auto flown = flown_before(a.file);
  std::ofstream out(a.file, std::ios::app);
  if (!out) {
    fmt::print(stderr, "goshawk_live_campaign: cannot write {}\n", a.file);
    return 2;
  }
  out << '\n';  // after a line that was cut off
  const std::set<std::uint64_t> before = [&] {
    std::set<std::uint64_t> numbers;
    for (const auto& [number, result] : flown) numbers.insert(number);
    return numbers;
  }();
  std::atomic<std::uint64_t> next = a.first;
  std::mutex mutex;
  const auto begin = std::chrono::steady_clock::now();
  const auto in_time = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() <
           a.seconds;
  };
  const auto work = [&] {
    while (in_time()) {
      const std::uint64_t number = next++;
      if (number >= a.first + a.flights) return;
      if (before.contains(number)) continue;
      json result = fly_one(number, vehicle, a.latency_s);
      const std::scoped_lock lock(mutex);
      out << result.dump() << '\n' << std::flush;
      flown[number] = std::move(result);
    }
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < a.jobs; ++i) threads.emplace_back(work);
  }
  const json summary = summary_of(a, flown);
  if (a.json) {
    fmt::print("{}\n", summary.dump());
  } else {
    for (const auto& [key, value] : summary.items()) fmt::print("{}: {}\n", key, value.dump());
  }
  if (!out) fmt::print(stderr, "goshawk_live_campaign: cannot write {}\n", a.file);
  return !out ? 2 : summary["contacts"] > 0 ? 1 : 0;
}

int run(const Arguments& a) {
  closed_loop::Setup vehicle;
  if (auto status = apply_file(a.vehicle_file, vehicle); !status) {
    fmt::print(stderr, "goshawk_live_campaign: {}\n", status.error().message);
    return 2;
  }
  return fly_all(a, vehicle);
}

}  // namespace
}  // namespace goshawk::league

int main(int argc, char** argv) {
  const auto arguments = goshawk::league::parse(argc, argv);
  if (arguments) return goshawk::league::run(*arguments);
  fmt::print(stderr, "goshawk_live_campaign: {}\n{}", arguments.error().message,
             goshawk::league::kUsage);
  return 2;
}
