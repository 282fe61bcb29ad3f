#include "goshawk/introspection/interruptible.hpp"

#include <signal.h>

#include <atomic>

namespace goshawk::introspection {
namespace {

std::atomic<bool> g_interrupted = false;  // signal handlers reach nothing else
int g_depth = 0;                          // of objects that live: only the outermost has handlers
struct sigaction g_old_int, g_old_term, g_old_size;

}  // namespace

Interruptible::Interruptible() {
  if (g_depth++ > 0) return;
  g_interrupted = false;
  struct sigaction action {};
  action.sa_handler = [](int) { g_interrupted = true; };
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &g_old_int);
  sigaction(SIGTERM, &action, &g_old_term);
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, &g_old_size);
}

Interruptible::~Interruptible() {
  if (--g_depth > 0) return;
  sigaction(SIGINT, &g_old_int, nullptr);
  sigaction(SIGTERM, &g_old_term, nullptr);
  sigaction(SIGXFSZ, &g_old_size, nullptr);
}

bool Interruptible::interrupted() {
  return g_interrupted;
}

}  // namespace goshawk::introspection
