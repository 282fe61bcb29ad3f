#include "goshawk/path_search/query.hpp"

#include <cmath>

namespace goshawk::path_search {

Status StopSignal::check() const {
  if (token.stop_requested()) {
    return fail(ErrorCode::cancelled, "the search was cancelled by its caller");
  }
  if (deadline && Clock::now() >= *deadline) {
    return fail(ErrorCode::deadline_exceeded,
                "the search was not done in time: allow more (time_limit_s, the request's "
                "deadline), or choose a coarser map or a nearer goal");
  }
  return success();
}

StopSignal StopSignal::after(double seconds) {
  constexpr double kCentury = 3e9;
  StopSignal stop;
  if (!(seconds < kCentury)) return stop;
  stop.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                     std::chrono::duration<double>(std::max(seconds, 0.0)));
  return stop;
}

}  // namespace goshawk::path_search
