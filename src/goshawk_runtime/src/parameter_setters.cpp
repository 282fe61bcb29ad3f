#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "context_impl.hpp"
#include "parameter_service.hpp"
#include "writer_guard.hpp"

namespace goshawk::runtime {
namespace {

// The kernel knows whose a socket of 127.0.0.1 is: proc(5), /proc/net/udp.
std::optional<uid_t> owner_of(std::uint16_t port) {
  std::ifstream table("/proc/net/udp");
  std::string line;
  std::getline(table, line);  // the names of the columns
  while (std::getline(table, line)) {
    unsigned address = 0, local_port = 0, owner = 0;
    const int read = std::sscanf(line.c_str(), " %*u: %x:%x %*x:%*x %*x %*x:%*x %*x:%*x %*x %u",
                                 &address, &local_port, &owner);
    const bool on_loopback = address == 0x0100007FU || address == 0;  // as the kernel prints them
    if (read == 3 && local_port == port && on_loopback) return owner;
  }
  return {};
}

Status check_user(Context::Impl& context, const Participant& asker) {
  if (context.has_permissions) return success();  // who may write the topic is signed
  if (asker == participant_of(context.participant->guid().guidPrefix)) return success();
  constexpr const char* kMend = "to allow it, start the node with -p set_parameters:=any";
  const auto port = context.senders->port_of(asker);
  if (!port) {
    return fail(ErrorCode::not_permitted,
                fmt::format("{} is not on the loopback of this machine, so nobody can tell whose "
                            "process it is; {}, or use DDS Security",
                            context.listener.describe(asker), kMend));
  }
  const auto owner = owner_of(*port);
  if (owner && (*owner == geteuid() || *owner == 0)) return success();
  return fail(ErrorCode::not_permitted, fmt::format("{} belongs to another user; {}",
                                                    context.listener.describe(asker), kMend));
}

}  // namespace

Status check_setter(Context::Impl& context, const Participant& asker, ParameterSetters setters) {
  switch (setters) {
    case ParameterSetters::any:
      return success();
    case ParameterSetters::none:
      return fail(ErrorCode::not_permitted,
                  "the parameters of this node are fixed: it was started with set_parameters none");
    case ParameterSetters::user:
      break;
  }
  return check_user(context, asker);
}

}  // namespace goshawk::runtime
