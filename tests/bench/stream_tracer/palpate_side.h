/// Palpate's lines in the comparison.
#pragma once

#include <vector>

#include "common/trace/trace.h"
#include "tests/bench/stream_tracer/case.h"
#include "tests/bench/stream_tracer/curve_error.h"

namespace palpate::bench {

/// The lines as curves, in the order of the seeds.
[[nodiscard]] std::vector<Curve> curves_of(const TraceResult& result, std::size_t seeds);

[[nodiscard]] TraceOptions options_of(Integrator integrator, double tolerance, int threads);

/// Median seconds of `repeats` runs, or more where they are short: processor time of one thread, wall time of
/// several.
[[nodiscard]] double trace_seconds(const VectorField& field, const Case& c, const TraceOptions& options,
                                   int repeats, TraceResult& result);

}  // namespace palpate::bench
