#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "goshawk/conformance/conform.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk/runtime/private_domain.hpp"

namespace goshawk::conformance_test {

inline std::unique_ptr<runtime::Context> join(int domain) {
  runtime::ContextOptions options;
  options.domain = domain;
  auto context = runtime::Context::create(options);
  if (!context) throw std::runtime_error(context.error().message);
  return *std::move(context);
}

/// Names of the items that did not pass.
inline std::vector<std::string> failed(const conformance::Report& report) {
  std::vector<std::string> names;
  for (const auto& item : report.items) {
    if (!item.passed) names.push_back(item.name);
  }
  return names;
}

/// Examines Stage(node, fault), which runs in a thread and a domain of its own.
template <typename Stage, typename Fault>
conformance::Report examine(const conformance::Options& options, Fault fault) {
  const int domain = runtime::hold_private_domain().value();
  const auto theirs = join(domain);
  runtime::Node node(*theirs, options.stage);
  const Stage stage(node, fault);
  std::thread thread([&] { node.spin(); });
  const auto ours = join(domain);
  const auto report = conformance::conform(*ours, options);
  node.stop();
  thread.join();
  if (!report) throw std::runtime_error(report.error().message);
  return *report;
}

/// Several at once: they wait most of the time. @return the reports in the order of the faults
template <typename Stage, typename Fault>
std::vector<conformance::Report> examine_all(const conformance::Options& options,
                                             const std::vector<Fault>& faults) {
  std::vector<conformance::Report> reports(faults.size());
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < faults.size(); ++k) {
    threads.emplace_back([&, k] { reports[k] = examine<Stage>(options, faults[k]); });
  }
  for (auto& thread : threads) thread.join();
  return reports;
}

}  // namespace goshawk::conformance_test
