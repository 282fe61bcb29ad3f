#include "tally.hpp"

#include <algorithm>

namespace goshawk::conformance {

Item ReportListener::refusal(const std::string& name, const std::set<std::string>& codes) const {
  std::string wanted;
  for (const auto& code : codes) wanted += (wanted.empty() ? "" : " or ") + code;
  Item item{"refuses " + name, false, "must be " + wanted + ", but "};
  if (reports_.empty()) {
    item.detail += "no report came";
    return item;
  }
  const auto& report = reports_.front();
  item.detail += report.code() + " came: " + report.message();
  if (!codes.contains(report.code())) return item;
  if (report.message().empty()) {
    item.detail = report.code() + " came without a sentence";
    return item;
  }
  return {item.name, true, report.code()};
}

void add_latency(Report& report, std::vector<double> latencies_s) {
  if (latencies_s.empty()) return;
  std::ranges::sort(latencies_s);
  const auto at = [&](double share) {
    return latencies_s[std::size_t(share * double(latencies_s.size() - 1) + 0.5)];
  };
  report.latency_p50_s = at(0.5);
  report.latency_p99_s = at(0.99);
  report.latency_max_s = latencies_s.back();
}

}  // namespace goshawk::conformance
