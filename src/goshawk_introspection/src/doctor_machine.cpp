#include <ifaddrs.h>
#include <net/if.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>

#include "doctor.hpp"

namespace goshawk::introspection {
namespace {

constexpr long kSocketBuffer = 4 << 20;            // [byte] what runtime's Context asks for
constexpr double kLeastSharedMemory = 32 << 20;    // [byte] for maps of 10^8 voxels
constexpr std::time_t kNoEarlier = 1'767'225'600;  // [s] 2026-01-01: no flight was before

Finding check_cores() {
  const unsigned cores = std::thread::hardware_concurrency();
  if (cores >= 2) return {"processor", Level::fine, std::to_string(cores) + " cores"};
  return {"processor", Level::warning,
          "one core for seven stages: prefer one process, with goshawk launch flight_container"};
}

Finding check_loopback() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return {"loopback", Level::fault, "interfaces cannot be listed"};
  bool up = false;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    up = up || ((i->ifa_flags & IFF_LOOPBACK) != 0 && (i->ifa_flags & IFF_UP) != 0);
  }
  freeifaddrs(list);
  if (up) return {"loopback", Level::fine, "is up"};
  return {"loopback", Level::fault, "is down, so stages cannot talk: ip link set lo up"};
}

Finding check_buffer(const std::string& name) {
  const std::string about = "net.core." + name;
  long most = 0;
  if (!(std::ifstream("/proc/sys/net/core/" + name) >> most)) {
    return {about, Level::note, "cannot be read here"};
  }
  if (most >= kSocketBuffer) return {about, Level::fine, std::to_string(most) + " byte"};
  return {about, Level::warning,
          std::to_string(most) +
              " byte: whole maps of millions of voxels come late or in several "
              "tries: sysctl -w " +
              about + "=" + std::to_string(kSocketBuffer)};
}

Finding check_shared_memory() {
  struct statvfs info {};
  if (statvfs("/dev/shm", &info) != 0 || access("/dev/shm", W_OK) != 0) {
    return {"shared memory", Level::note,
            "/dev/shm is not writable: a profile file that uses shared memory will not work; "
            "loopback does"};
  }
  int left = 0;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", ignored)) {
    left += entry.path().filename().string().starts_with("fastrtps_") ? 1 : 0;
  }
  const double free_bytes = double(info.f_bavail) * double(info.f_frsize);
  const std::string files = left == 0 ? "" : ", " + std::to_string(left) + " segments of Fast DDS";
  if (free_bytes < kLeastSharedMemory) {
    return {"shared memory", Level::warning,
            "/dev/shm is nearly full" + files + ": fastdds shm clean removes what no process uses"};
  }
  return {"shared memory", Level::fine,
          std::to_string(long(free_bytes / (1 << 20))) + " MiB free" + files};
}

Finding check_clock() {
  if (std::time(nullptr) < kNoEarlier) {
    return {"clock", Level::warning, "is before 2026: set it, as stamps are compared"};
  }
  timex state{};
  const bool synchronised = adjtimex(&state) != TIME_ERROR && (state.status & STA_UNSYNC) == 0;
  if (synchronised) return {"clock", Level::fine, "is synchronised"};
  return {"clock", Level::note,
          "is not synchronised: no harm on one machine; for stages on several, run chrony"};
}

Finding check_priority() {
  rlimit limit{};
  const bool may =
      geteuid() == 0 || (getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur >= 20);
  if (may) return {"real-time priority", Level::fine, "is permitted"};
  return {"real-time priority", Level::note,
          "is not permitted, so a busy machine delays the control loop: add '" +
              std::string(std::getenv("USER") != nullptr ? std::getenv("USER") : "you") +
              " - rtprio 20' to /etc/security/limits.conf"};
}

Finding check_profile() {
  const char* path = std::getenv("FASTRTPS_DEFAULT_PROFILES_FILE");
  if (path == nullptr) return {"profile file", Level::fine, "none: UDP on the chosen interfaces"};
  std::ifstream file(path);
  char first = 0;
  if (!(file >> first)) {
    return {"profile file", Level::fault,
            std::string(path) + " cannot be read: mend FASTRTPS_DEFAULT_PROFILES_FILE or unset it"};
  }
  if (first != '<') {
    return {"profile file", Level::fault, std::string(path) + " is not XML: Fast DDS ignores it"};
  }
  return {"profile file", Level::note, std::string(path) + " decides about transports"};
}

}  // namespace

std::string to_string(Level level) {
  switch (level) {
    case Level::fine:
      return "fine";
    case Level::note:
      return "note";
    case Level::warning:
      return "warning";
    case Level::fault:
      return "fault";
  }
  return "";
}

std::vector<Finding> check_machine() {
  return {
      check_cores(),         check_loopback(), check_buffer("rmem_max"), check_buffer("wmem_max"),
      check_shared_memory(), check_clock(),    check_priority()};
}

std::vector<Finding> check_environment() {
  std::vector<Finding> findings{check_profile()};
  const auto options = runtime::ContextOptions::from_environment();
  if (options) {
    findings.push_back(
        {"domain", Level::fine, std::to_string(options->domain) + " on " + options->interfaces});
  } else {
    findings.push_back({"domain", Level::fault, options.error().message});
  }
  return findings;
}

}  // namespace goshawk::introspection
