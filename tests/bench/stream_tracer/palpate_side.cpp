#include "tests/bench/stream_tracer/palpate_side.h"

#include <algorithm>

#include "common/base/clock.h"
#include "tests/bench/stream_tracer/rows.h"

namespace palpate::bench {

std::vector<Curve> curves_of(const TraceResult& result, std::size_t seeds) {
  std::vector<Curve> curves(seeds);
  for (const Line& line : result.lines) {
    Curve& curve = curves[line.seed];
    for (const LinePoint& point : line.points) curve.points.push_back(point.position);
    curve.leaves = line.end == End::kLeftDomain;
  }
  return curves;
}

TraceOptions options_of(Integrator integrator, double tolerance, int threads) {
  TraceOptions options;
  options.integrator = integrator;
  options.tolerance = tolerance;
  options.threads = threads;
  options.max_steps = 3'000'000;
  return options;
}

double trace_seconds(const VectorField& field, const Case& c, const TraceOptions& options, int repeats,
                     TraceResult& result) {
  std::vector<double> seconds;
  // Runs of a millisecond are repeated until the first ones, on cold caches, no longer matter.
  constexpr double kLongEnough = 0.05;  // seconds
  double total = 0.0;
  for (int i = 0; i < repeats || total < kLongEnough; ++i) {
    const Stopwatch watch;
    const double start = processor_seconds();
    result = trace_lines(field, c.seeds, options);
    seconds.push_back(options.threads == 1 ? processor_seconds() - start : watch.seconds());
    total += seconds.back();
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

}  // namespace palpate::bench
