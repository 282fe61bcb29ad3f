#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "goshawk/introspection/doctor.hpp"

namespace goshawk::introspection {
namespace {

constexpr long kSocketBuffer = 4 << 20;          // [byte] what runtime's Context asks for
constexpr double kLeastSharedMemory = 32 << 20;  // [byte] for maps of 10^8 voxels
constexpr double kGiB = 1 << 30;
constexpr double kLeastDisk = 1.0;  // [GiB]
constexpr double kNoDisk = 0.1;     // [GiB]

Finding check_cores() {
  const unsigned cores = std::thread::hardware_concurrency();
  if (cores >= 2) return {"processor", Level::fine, fmt::format("{} cores", cores)};
  return {"processor", Level::warning, "one core",
          "seven stages share it, so every message waits until the next stage runs",
          "prefer one process: goshawk launch flight_container"};
}

Finding check_loopback() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) {
    return {"loopback", Level::fault, "interfaces cannot be listed",
            "the connection between the stages cannot be checked",
            "ask the machine's administrator"};
  }
  bool up = false;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    up = up || ((i->ifa_flags & IFF_LOOPBACK) != 0 && (i->ifa_flags & IFF_UP) != 0);
  }
  freeifaddrs(list);
  if (up) return {"loopback", Level::fine, "is up"};
  return {"loopback", Level::fault, "is down", "stages on one machine communicate over it",
          "ip link set lo up"};
}

Finding check_buffer(const std::string& name) {
  const std::string about = "net.core." + name;
  long most = 0;
  if (!(std::ifstream("/proc/sys/net/core/" + name) >> most)) {
    return {about, Level::note, "cannot be read here", "whole maps are delayed if it is small",
            "sysctl " + about + " outside the container shows it"};
  }
  if (most >= kSocketBuffer) return {about, Level::fine, std::to_string(most) + " byte"};
  return {about, Level::warning, std::to_string(most) + " byte",
          "maps of millions of voxels are delayed or sent several times",
          "sysctl -w " + about + "=" + std::to_string(kSocketBuffer)};
}

Finding check_shared_memory() {
  struct statvfs info {};
  if (statvfs("/dev/shm", &info) != 0 || access("/dev/shm", W_OK) != 0) {
    return {"shared memory", Level::note, "/dev/shm is not writable",
            "a profile file that uses shared memory will not work; loopback, the default, does",
            "mount a tmpfs there, or run the container with --shm-size 256m"};
  }
  int left = 0;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", ignored)) {
    left += entry.path().filename().string().starts_with("fastrtps_") ? 1 : 0;
  }
  const double free_bytes = double(info.f_bavail) * double(info.f_frsize);
  const std::string files = left == 0 ? "" : fmt::format(", {} segments of Fast DDS", left);
  if (free_bytes < kLeastSharedMemory) {
    return {"shared memory", Level::warning, "/dev/shm is nearly full" + files,
            "a profile file that uses shared memory fails when it is full",
            "fastdds shm clean removes unused segments"};
  }
  return {"shared memory", Level::fine,
          std::to_string(long(free_bytes / (1 << 20))) + " MiB free" + files};
}

// The default folder of recordings and flight folders.
Finding check_disk() {
  struct statvfs info {};
  if (statvfs(".", &info) != 0) {
    return {"disk", Level::note, "this folder cannot be examined",
            "recordings are written here by default", "work in a folder that you may write to"};
  }
  const double free_gib = double(info.f_bavail) * double(info.f_frsize) / kGiB;
  char text[64];
  std::snprintf(text, sizeof text, "%.1f GiB free here", free_gib);
  const char* why = "a recording stops when the disk is full; it stays readable up to there";
  const char* mend = "free space, or write elsewhere: goshawk record -o FILE, fly --output FOLDER";
  if (access(".", W_OK) != 0) {
    return {"disk", Level::warning, "this folder is not writable",
            "recordings and flight folders are written here by default", mend};
  }
  if (free_gib >= kLeastDisk) return {"disk", Level::fine, text};
  return {"disk", free_gib < kNoDisk ? Level::fault : Level::warning, text, why, mend};
}

Finding check_priority() {
  rlimit limit{};
  const bool may =
      geteuid() == 0 || (getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur >= 20);
  if (may) return {"real-time priority", Level::fine, "is permitted"};
  return {"real-time priority", Level::note, "is not permitted",
          "a busy machine delays the control loop",
          "add '" + std::string(std::getenv("USER") != nullptr ? std::getenv("USER") : "you") +
              " - rtprio 20' to /etc/security/limits.conf"};
}

Finding check_profile() {
  const char* path = std::getenv("FASTRTPS_DEFAULT_PROFILES_FILE");
  if (path == nullptr) return {"profile file", Level::fine, "none: UDP on the chosen interfaces"};
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  const std::string name = path, xml = text.str();
  const char* why = "it decides about transports instead of Goshawk";
  const char* mend = "correct FASTRTPS_DEFAULT_PROFILES_FILE, or unset it";
  const auto first = xml.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) {
    return {"profile file", Level::fault, name + " cannot be read, or is empty", why, mend};
  }
  if (xml[first] != '<' && !xml.starts_with("\xEF\xBB\xBF<")) {
    return {"profile file", Level::fault, name + " is not XML: Fast DDS ignores it", why, mend};
  }
  if (xml.find("is_default_profile=\"true\"") == std::string::npos) {
    return {"profile file", Level::warning, name + " has no profile with is_default_profile=true",
            "participants then use Fast DDS' defaults: multicast, on every interface",
            "add that attribute to the participant's profile"};
  }
  return {"profile file", Level::note, name + " decides about transports",
          "Goshawk's own choice, UDP on GOSHAWK_INTERFACES, does not apply",
          "unset it to restore that choice"};
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
      check_shared_memory(), check_disk(),     check_priority()};
}

std::vector<Finding> check_environment() {
  std::vector<Finding> findings{check_profile()};
  const auto options = runtime::ContextOptions::from_environment();
  if (options) {
    findings.push_back(
        {"domain", Level::fine, fmt::format("{} on {}", options->domain, options->interfaces)});
  } else {
    findings.push_back({"domain", Level::fault, options.error().message, "no process can join it",
                        "set it to a number from 0 to 232, or unset it"});
  }
  return findings;
}

}  // namespace goshawk::introspection
