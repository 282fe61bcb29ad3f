// The wall clock of the process, stepped: readings, and deadlines on it. Steps come from control(),
// and $GOSHAWK_LAB_CLOCK_S says how many seconds it is ahead from the start (below zero: behind),
// as that of another host. The monotonic clocks, which nobody can set, are left alone. A wait that
// is under way when the clock is stepped keeps its length.

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/time.h>
#include <time.h>

#include <cstdlib>

#include "control.hpp"

namespace {

using goshawk::faults::control;

constexpr std::int64_t kNsInS = 1'000'000'000;
// A deadline of a condition variable may be on either clock; monotonic ones are far below this.
constexpr std::int64_t kNoMonotonic_s = 1'000'000'000;

std::int64_t lab_offset_ns() {
  static const std::int64_t offset = [] {
    const char* text = std::getenv("GOSHAWK_LAB_CLOCK_S");
    return text == nullptr ? 0 : std::int64_t(std::strtod(text, nullptr) * double(kNsInS));
  }();
  return offset;
}

std::int64_t offset_ns() {
  const auto* c = control();
  return lab_offset_ns() + (c == nullptr ? 0 : c->wall_offset_ns.load(std::memory_order_relaxed));
}

timespec shifted(timespec t, std::int64_t by_ns) {
  const std::int64_t ns = std::int64_t{t.tv_sec} * kNsInS + t.tv_nsec + by_ns;
  return {.tv_sec = time_t(ns / kNsInS), .tv_nsec = long(ns % kNsInS)};
}

/// A deadline on the stepped clock, on the kernel's.
timespec on_kernel_clock(const timespec& deadline) {
  return deadline.tv_sec < kNoMonotonic_s ? deadline : shifted(deadline, -offset_ns());
}

/// The C library's own function of a name. @param version where several were ever needed, as on x86
template <typename Function>
Function* own(const char* name, const char* version = nullptr) {
  void* found = version == nullptr ? nullptr : dlvsym(RTLD_NEXT, name, version);
  return reinterpret_cast<Function*>(found == nullptr ? dlsym(RTLD_NEXT, name) : found);
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* out) noexcept {
  static auto* const next = own<int(clockid_t, timespec*)>("clock_gettime");
  const int result = next(clock, out);
  const bool wall = clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE;
  if (result == 0 && wall) *out = shifted(*out, offset_ns());
  return result;
}

int gettimeofday(timeval* out, void*) noexcept {
  timespec t{};
  const int result = clock_gettime(CLOCK_REALTIME, &t);
  *out = {.tv_sec = t.tv_sec, .tv_usec = t.tv_nsec / 1000};
  return result;
}

time_t time(time_t* out) noexcept {
  timespec t{};
  clock_gettime(CLOCK_REALTIME_COARSE, &t);
  if (out != nullptr) *out = t.tv_sec;
  return t.tv_sec;
}

int pthread_cond_timedwait(pthread_cond_t* c, pthread_mutex_t* m, const timespec* deadline) {
  // Without the version the C library hands out the one of 1998, for another type.
  static auto* const next = own<int(pthread_cond_t*, pthread_mutex_t*, const timespec*)>(
      "pthread_cond_timedwait", "GLIBC_2.3.2");
  const timespec t = on_kernel_clock(*deadline);
  return next(c, m, &t);
}

int pthread_mutex_timedlock(pthread_mutex_t* m, const timespec* deadline) noexcept {
  static auto* const next = own<int(pthread_mutex_t*, const timespec*)>("pthread_mutex_timedlock");
  const timespec t = on_kernel_clock(*deadline);
  return next(m, &t);
}

int sem_timedwait(sem_t* s, const timespec* deadline) {
  static auto* const next = own<int(sem_t*, const timespec*)>("sem_timedwait");
  const timespec t = on_kernel_clock(*deadline);
  return next(s, &t);
}

}  // extern "C"
