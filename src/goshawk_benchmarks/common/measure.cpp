#include "common/measure.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

namespace goshawk::bench {
namespace {

/// Results go into a Report; Google Benchmark itself stays quiet.
class Quiet : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

double nearest_rank(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) throw std::logic_error("a quantile of no samples");
  const double rank = std::ceil(q * double(sorted.size())) - 1.0;
  return sorted[std::size_t(std::clamp(rank, 0.0, double(sorted.size() - 1)))];
}

double now_s(Clock clock) {
  timespec t{};
  clock_gettime(clock == Clock::wall ? CLOCK_MONOTONIC : CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double seconds_of(const std::function<void()>& run, Clock clock) {
  const double begin_s = now_s(clock);
  run();
  return now_s(clock) - begin_s;
}

}  // namespace

double time_us(const std::function<void()>& run, Clock clock) {
  return 1e6 * seconds_of(run, clock);
}

double Timing::quantile_us(double q) const {
  return nearest_rank(sorted_us, q);
}

void Timing::append(const Timing& other) {
  sorted_us.insert(sorted_us.end(), other.sorted_us.begin(), other.sorted_us.end());
  std::ranges::sort(sorted_us);
}

std::vector<Timing> compare(const std::string& name, const std::vector<Contender>& contenders,
                            int rounds, Clock clock) {
  if (rounds < 1) throw std::logic_error("a comparison of no rounds");
  std::vector<Timing> timings(contenders.size());
  for (const Contender& c : contenders) c.run();
  benchmark::RegisterBenchmark(name.c_str(),
                               [&](benchmark::State& state) {
                                 std::size_t turn = 0;
                                 for (auto _ : state) {
                                   double sum_s = 0.0;
                                   for (std::size_t i = 0; i < contenders.size(); ++i) {
                                     const std::size_t which = (i + turn) % contenders.size();
                                     const double s = seconds_of(contenders[which].run, clock);
                                     timings[which].sorted_us.push_back(s * 1e6);
                                     sum_s += s;
                                   }
                                   ++turn;
                                   state.SetIterationTime(sum_s);
                                 }
                               })
      ->Iterations(rounds)
      ->UseManualTime();
  Quiet quiet;
  benchmark::RunSpecifiedBenchmarks(&quiet, ".*");
  benchmark::ClearRegisteredBenchmarks();
  for (Timing& t : timings) std::ranges::sort(t.sorted_us);
  return timings;
}

double at_share(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? 0.0 : sorted[std::size_t(share * double(sorted.size() - 1) + 0.5)];
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return nearest_rank(values, 0.5);
}

}  // namespace goshawk::bench
