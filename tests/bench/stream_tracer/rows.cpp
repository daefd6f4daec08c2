#include "tests/bench/stream_tracer/rows.h"

#include <cstdio>
#include <ctime>

namespace palpate::bench {

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void print(const Row& row) {
  std::printf("  %-16s %-34s p95 error %9.2e   %10.1f lines/s\n", row.method.c_str(), row.parameter.c_str(),
              row.error, row.lines_per_second);
  std::fflush(stdout);
}

const Row* best(const std::vector<Row>& rows, double error) {
  const Row* found = nullptr;
  for (const Row& row : rows) {
    if (row.error <= error && (found == nullptr || row.lines_per_second > found->lines_per_second))
      found = &row;
  }
  return found;
}

}  // namespace palpate::bench
