#include "goshawk/introspection/doctor_command.hpp"

#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>

#include "doctor.hpp"
#include "session.hpp"
#include "text.hpp"

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;

void add(std::vector<Finding>& all, std::vector<Finding> more) {
  std::ranges::move(more, std::back_inserter(all));
}

// Who is here; and where nobody is, in which other domains of this machine somebody is.
Finding company(const std::vector<runtime::ParticipantInfo>& participants, int domain) {
  if (!participants.empty()) {
    std::string nodes;
    for (const auto& p : participants) {
      for (const auto& node : p.nodes) nodes += (nodes.empty() ? "" : ", ") + node;
    }
    return {"domain " + std::to_string(domain), Level::fine,
            std::to_string(participants.size()) + " processes" +
                (nodes.empty() ? "" : ", with the nodes " + nodes)};
  }
  std::stringstream table;
  table << std::ifstream("/proc/net/udp").rdbuf();
  std::string others;
  for (const int d : domains_in_use(table.str())) {
    if (d != domain) others += (others.empty() ? "" : ", ") + std::to_string(d);
  }
  return {"domain " + std::to_string(domain), Level::note,
          others.empty() ? "nobody is here, nor in another domain of this machine"
                         : "nobody is here, but there is in " + others +
                               ": set ROS_DOMAIN_ID to see that one"};
}

std::vector<Finding> examine(double timeout_s) {
  std::vector<Finding> findings = check_machine();
  add(findings, check_environment());
  auto session = Session::open();
  if (!session) {
    findings.push_back({"domain", Level::fault, session.error().message});
    return findings;
  }
  (*session)->settle(timeout_s);
  auto& context = (*session)->context();
  findings.push_back(company(context.participants(), context.domain()));
  add(findings, check_topics(context.participants(), context.endpoints()));
  return findings;
}

void print(const std::vector<Finding>& findings) {
  for (const auto& f : findings) {
    const std::string level = to_string(f.level);
    std::cout << level << std::string(9 - level.size(), ' ') << f.about << ": " << f.message
              << "\n";
  }
}

int doctor(const CommonOptions& common) {
  const auto findings = examine(common.timeout_s);
  Level worst = Level::fine;
  Json list = Json::array();
  for (const auto& f : findings) {
    worst = std::max(worst, f.level);
    list.push_back({{"about", f.about}, {"level", to_string(f.level)}, {"message", f.message}});
  }
  if (common.json) {
    std::cout << to_line({{"ok", worst < Level::fault}, {"findings", list}}) << std::endl;
  } else {
    print(findings);
    std::cout << (worst < Level::fault ? "nothing stands in the way of a flight"
                                       : "mend what is called a fault above")
              << std::endl;
  }
  return worst < Level::fault ? 0 : kNothing;
}

}  // namespace

int doctor_command(std::vector<std::string> arguments) {
  return run_one(
      "doctor",
      {"doctor", "looks at machine, settings and domain, and says what does not fit",
       [](CLI::App&, CommonOptions& common) { return [&common] { return doctor(common); }; }},
      std::move(arguments));
}

}  // namespace goshawk::introspection
