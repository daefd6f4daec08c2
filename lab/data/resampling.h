/// What it costs to take a scalar on a uniform grid: the error of its interpolant there (scalar_lattice.h)
/// and the time, against the number of points. Where the scalar is smooth the error falls as the square of
/// their distance; where it jumps, as with measures that are constant in cells, it hardly falls at all.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/scalar_lattice.h"
#include "lab/data/sweep.h"
#include "lab/page/section.h"

namespace palpate {

struct ResampledScalar {
  std::string name;
  ScalarSampler sample;
};

struct ResamplingRow {
  std::string scalar;
  Index3 points{0};
  LatticeError error;
  double seconds = 0.0;  ///< of taking the values, on the threads asked for
};

/// Each scalar at 16, 32, 64, … points along the longest edge of `bounds`: up to 64, 128 or 256 by `effort`.
/// @param threads 0: all cores. @throws Cancelled.
[[nodiscard]] std::vector<ResamplingRow> run_resampling(const std::vector<ResampledScalar>& scalars,
                                                        const Box& bounds, Effort effort, int threads,
                                                        Progress* progress);

/// @param subject what was opened.
[[nodiscard]] ReportSection resampling_section(const std::string& subject,
                                               const std::vector<ResamplingRow>& rows);

}  // namespace palpate
