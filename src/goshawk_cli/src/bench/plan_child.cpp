#include "bench/plan_child.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <utility>

#include "json.hpp"

namespace goshawk::cli {
namespace {

constexpr char kSample = 's', kProcessor = 'p';

Json to_json(const Error& error) {
  return {{"code", std::string(to_string(error.code))}, {"message", error.message}};
}

Json to_json(const PlanSample& sample) {
  Json stages = Json::object();
  for (const auto& [name, times] : sample.stages) {
    stages[name] = {times.compute_ns, times.wire_ns};
  }
  return {{"total_ns", sample.total_ns}, {"stages", stages}};
}

PlanSample sample_of(const Json& object) {
  PlanSample sample{.total_ns = object.at("total_ns").get<std::int64_t>(), .stages = {}};
  for (const auto& [name, times] : object.at("stages").items()) {
    sample.stages[name] = {times.at(0).get<std::int64_t>(), times.at(1).get<std::int64_t>()};
  }
  return sample;
}

/// @return the failure that the child told of, or nothing
std::optional<Error> error_in(const Json& object) {
  if (!object.contains("code")) return {};
  const std::string name = object.at("code").get<std::string>();
  for (const ErrorCode code : all_error_codes()) {
    if (to_string(code) == name) return Error{code, object.at("message").get<std::string>()};
  }
  return Error{ErrorCode::io_failed, object.at("message").get<std::string>()};
}

bool tell(int socket, const Json& object) {
  const std::string line = object.dump() + "\n";
  return send(socket, line.data(), line.size(), MSG_NOSIGNAL) == ssize_t(line.size());
}

Json answer_to(char question, PlanRig& rig) {
  if (question == kProcessor) return {{"processor_s", rig.processor_s()}};
  const auto sample = rig.sample();
  return sample ? to_json(*sample) : to_json(sample.error());
}

/// Answers until its parent asks no more.
void serve(int socket, const PlanRigOptions& options) {
  const auto rig = PlanRig::start(options);
  if (!tell(socket, rig ? Json::object() : to_json(rig.error())) || !rig) return;
  for (char question = 0; read(socket, &question, 1) == 1;) {
    if (!tell(socket, answer_to(question, **rig))) return;
  }
}

}  // namespace

Result<PlanChild> PlanChild::start(const PlanRigOptions& options) {
  std::array<int, 2> sockets{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0) {
    return fail(ErrorCode::io_failed, "no socket to another process could be opened");
  }
  const pid_t pid = fork();
  if (pid < 0) {
    for (const int socket : sockets) close(socket);
    return fail(ErrorCode::io_failed, "no other process could be started");
  }
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    close(sockets[0]);
    serve(sockets[1], options);
    _exit(0);
  }
  close(sockets[1]);
  return PlanChild(pid, sockets[0]);
}

PlanChild::PlanChild(PlanChild&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      socket_(std::exchange(other.socket_, -1)),
      received_(std::move(other.received_)) {}

PlanChild::~PlanChild() {
  if (pid_ < 0) return;
  close(socket_);
  waitpid(pid_, nullptr, 0);
}

Result<std::string> PlanChild::read_line() {
  for (std::size_t end = 0; (end = received_.find('\n')) == std::string::npos;) {
    std::array<char, 4096> part{};
    const ssize_t size = read(socket_, part.data(), part.size());
    if (size <= 0) {
      return fail(ErrorCode::io_failed, "the process that asks the secured stages has ended");
    }
    received_.append(part.data(), std::size_t(size));
  }
  const std::size_t end = received_.find('\n');
  std::string line = received_.substr(0, end);
  received_.erase(0, end + 1);
  return line;
}

Result<std::string> PlanChild::ask(char question) {
  if (send(socket_, &question, 1, MSG_NOSIGNAL) != 1) {
    return fail(ErrorCode::io_failed, "the process that asks the secured stages has ended");
  }
  return read_line();
}

Status PlanChild::ready() {
  const auto line = read_line();
  if (!line) return line.error();
  if (auto error = error_in(Json::parse(*line))) return *error;
  return success();
}

Result<PlanSample> PlanChild::sample() {
  const auto line = ask(kSample);
  if (!line) return line.error();
  const Json object = Json::parse(*line);
  if (auto error = error_in(object)) return *error;
  return sample_of(object);
}

Result<double> PlanChild::processor_s() {
  const auto line = ask(kProcessor);
  if (!line) return line.error();
  return Json::parse(*line).at("processor_s").get<double>();
}

}  // namespace goshawk::cli
