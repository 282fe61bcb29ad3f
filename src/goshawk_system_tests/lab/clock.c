/* A library for LD_PRELOAD: the process's wall clock is GOSHAWK_LAB_CLOCK_S seconds ahead (below
 * zero: behind), as that of another host whose clock is wrong. Other clocks stay as they are. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static const long long NS = 1000000000LL;

static long long offset_ns(void) {
  static long long offset;
  static int known;
  if (!known) {
    const char* text = getenv("GOSHAWK_LAB_CLOCK_S");
    offset = text ? (long long)(strtod(text, NULL) * 1e9) : 0;
    known = 1;
  }
  return offset;
}

static void move(struct timespec* t, long long by_ns) {
  const long long ns = t->tv_nsec + by_ns % NS;
  t->tv_sec += (time_t)(by_ns / NS) + (time_t)(ns >= NS) - (time_t)(ns < 0);
  t->tv_nsec = (long)((ns + NS) % NS);
}

int clock_gettime(clockid_t clock, struct timespec* t) {
  const int status = (int)syscall(SYS_clock_gettime, clock, t);
  if (status == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) {
    move(t, offset_ns());
  }
  return status;
}

int gettimeofday(struct timeval* restrict t, void* restrict zone) {
  struct timespec now;
  (void)zone;
  clock_gettime(CLOCK_REALTIME, &now);
  t->tv_sec = now.tv_sec;
  t->tv_usec = now.tv_nsec / 1000;
  return 0;
}

time_t time(time_t* t) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (t) *t = now.tv_sec;
  return now.tv_sec;
}

/* Waits until a moment of the wall clock; those of the monotonic clock are small numbers. */
int pthread_cond_timedwait(pthread_cond_t* restrict condition, pthread_mutex_t* restrict mutex,
                           const struct timespec* restrict until) {
  static int (*real)(pthread_cond_t*, pthread_mutex_t*, const struct timespec*);
  if (!real) real = (__typeof__(real))dlvsym(RTLD_NEXT, "pthread_cond_timedwait", "GLIBC_2.3.2");
  struct timespec moment = *until;
  if (moment.tv_sec > 1000000000) move(&moment, -offset_ns());
  return real(condition, mutex, &moment);
}
