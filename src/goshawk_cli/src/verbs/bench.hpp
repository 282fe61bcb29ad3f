#pragma once

#include "verbs/verbs.hpp"

namespace goshawk::cli {

/// `goshawk bench plan`, the one that needs no program of goshawk_benchmarks.
void add_bench_plan(const Verb& bench);

}  // namespace goshawk::cli
