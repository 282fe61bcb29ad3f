// goshawk_container [--json] COMPONENT[:NODE_NAME] ... [--ros-args ...]: one or many components in
// one process, each with a node and a thread of its own. --json: a refusal is a JSON object.

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <thread>

#include "goshawk/runtime/component.hpp"

namespace {

using namespace goshawk;
using namespace goshawk::runtime;

constexpr int kWrongCall = 2;

struct Wanted {
  std::string component;
  std::string node;
};

// After the signal to stop: a component that computes on and on does not outlive it by more.
constexpr unsigned kLongestStop_s = 3;

bool g_json = false;  // how a refusal is told

int complain(const Error& error) {
  const std::string code(to_string(error.code));
  if (g_json) {
    const nlohmann::ordered_json object{{"ok", false}, {"code", code}, {"message", error.message}};
    fmt::print("{}\n", object.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    fmt::print(stderr, "goshawk_container: {}: {}\n", code, error.message);
  }
  return kWrongCall;
}

Result<std::vector<Wanted>> wanted_components(const std::vector<std::string>& arguments,
                                              const RosArgs& ros_args) {
  std::vector<Wanted> wanted;
  for (const auto& argument : arguments) {
    if (argument.starts_with("-")) {
      return fail(ErrorCode::invalid_input,
                  fmt::format("'{}' is not a component; options follow --ros-args", argument));
    }
    const auto colon = argument.find(':');
    const std::string component = argument.substr(0, colon);
    wanted.push_back(
        {component, colon == std::string::npos ? component : argument.substr(colon + 1)});
  }
  if (wanted.empty()) {
    return fail(ErrorCode::invalid_input,
                "no component named; usage: goshawk_container COMPONENT[:NODE_NAME] ... "
                "[--ros-args -r from:=to -p name:=value --params-file FILE]");
  }
  if (!ros_args.node_name.empty()) {
    if (wanted.size() > 1) {
      return fail(ErrorCode::invalid_input,
                  "__node names one node, but several components were asked for: write "
                  "COMPONENT:NODE_NAME");
    }
    wanted.front().node = ros_args.node_name;
  }
  return wanted;
}

Status check_nodes(const std::vector<Wanted>& wanted) {
  std::set<std::string> names;
  for (const auto& w : wanted) {
    if (auto status = check_topic_name(w.node); !status) return status;
    if (!names.insert(w.node).second) {
      return fail(ErrorCode::invalid_input,
                  "two nodes would be named " + w.node + ": write COMPONENT:NODE_NAME");
    }
  }
  return success();
}

struct Running {
  std::unique_ptr<Node> node;
  std::unique_ptr<Component> component;
  std::thread thread;
};

// Tries every component, to report all faults together.
Result<std::vector<const ComponentExport*>> load(const std::vector<Wanted>& wanted) {
  std::vector<const ComponentExport*> exports;
  std::optional<Error> fault;
  for (const auto& w : wanted) {
    auto component = load_component(w.component);
    if (component) {
      exports.push_back(*component);
    } else if (fault) {
      fault->message += "\n" + component.error().message;
    } else {
      fault = component.error();
    }
  }
  if (fault) return *fault;
  return exports;
}

int run(const std::vector<Wanted>& wanted, const RosArgs& ros_args, const sigset_t& signals) {
  auto exports = load(wanted);
  if (!exports) return complain(exports.error());
  auto options = ContextOptions::from_environment();
  if (!options) return complain(options.error());
  const std::string prefix = ros_args.node_namespace == "/" ? "" : ros_args.node_namespace;
  for (const auto& w : wanted) options->node_names.push_back(prefix + "/" + w.node);
  auto context = Context::create(*options);
  if (!context) return complain(context.error());

  std::vector<Running> running;
  int status = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    Running r;
    r.node = std::make_unique<Node>(**context, wanted[i].node, ros_args);
    try {
      r.component = (*exports)[i]->create(*r.node);
    } catch (const StartupFault& fault) {
      status = complain(fault.error());
    }
    running.push_back(std::move(r));
  }
  if (status != 0) return status;
  for (auto& r : running) {
    r.thread = std::thread([node = r.node.get()] { node->spin(); });
  }
  int signal = 0;
  sigwait(&signals, &signal);
  alarm(kLongestStop_s);
  for (auto& r : running) r.node->stop();
  for (auto& r : running) r.thread.join();
  for (auto& r : running) r.component.reset();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // Blocked in every thread, taken by sigwait alone.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments.front() == "--json") {
    g_json = true;
    arguments.erase(arguments.begin());
  }
  auto ros_args = RosArgs::extract(arguments);
  if (!ros_args) return complain(ros_args.error());
  auto wanted = wanted_components(arguments, *ros_args);
  if (!wanted) return complain(wanted.error());
  if (auto status = check_nodes(*wanted); !status) return complain(status.error());
  return run(*wanted, *ros_args, signals);
}
