#include "goshawk/introspection/doctor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "verbs/verbs.hpp"

namespace goshawk::cli {
namespace {

using introspection::Finding;
using introspection::Level;

void print(const std::vector<Finding>& findings, bool fault) {
  for (const auto& f : findings) {
    fmt::print("{:<9}{}: {}\n", to_string(f.level), f.about, f.message);
    if (!f.why.empty()) fmt::print("{:<9}why:  {}\n", "", f.why);
    if (!f.mend.empty()) fmt::print("{:<9}mend: {}\n", "", f.mend);
  }
  fmt::print("{}\n", fault ? "mend what is called a fault above"
                           : "nothing stands in the way of a flight");
}

int run_doctor(double timeout_s, const Console& console) {
  const auto findings = introspection::examine(timeout_s);
  const auto first = std::ranges::find(findings, Level::fault, &Finding::level);
  const bool fault = first != findings.end();
  if (!console.json()) {
    print(findings, fault);
    return fault ? kNotDone : kDone;
  }
  Json list = Json::array();
  for (const auto& f : findings) {
    list.push_back({{"about", f.about},
                    {"level", to_string(f.level)},
                    {"message", f.message},
                    {"why", f.why},
                    {"mend", f.mend}});
  }
  console.print_line({{"ok", !fault},
                      {"code", to_string(fault ? ErrorCode::io_failed : ErrorCode::ok)},
                      {"message", fault ? fmt::format("{}: {}", first->about, first->message) : ""},
                      {"findings", list}});
  return fault ? kNotDone : kDone;
}

}  // namespace

void add_doctor(Program& program) {
  const Verb verb = program.verb(
      "doctor", "look at machine, settings and domain: what does not fit, and how to mend it");
  auto timeout_s = std::make_shared<double>(2.0);
  add_timeout(verb, *timeout_s);
  verb->footer(
      "fine: nothing to do; note: worth knowing; warning: works, but not well; fault: does not\n"
      "work. Each says why it matters, and what mends it. Status 1 if there is a fault.");
  verb.runs([timeout_s](const Console& console) { return run_doctor(*timeout_s, console); });
}

}  // namespace goshawk::cli
