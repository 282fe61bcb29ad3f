#include "parts.hpp"

namespace {

void run(goshawk::bench::Report& report) {
  goshawk::bench::measure_flights(report);
  goshawk::bench::measure_cost(report);
  goshawk::bench::record_curve(report);
}

}  // namespace

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "trajectory", run);
}
