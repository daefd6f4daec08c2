/// How far noise turns the main direction of a fitted tensor, over diffusion weighting and noise, at the
/// gradients of the data at hand.
///
/// Signals of a prolate tensor, S_i = exp(-b_i g_i^T D g_i), get Rician noise (the length of a complex number
/// with normal noise of standard deviation 1 / SNR in both parts; Gudbjartsson and Patz 1995) and are fitted
/// as an image is (tensor_fit.h). The weightings of the table are scaled together, so that the largest is b.
/// While noise is small against all signals, the angle is proportional to it.
#pragma once

#include <vector>

#include "common/base/progress.h"
#include "common/field/tensor/gradient_table.h"
#include "lab/data/stability.h"
#include "lab/data/sweep.h"
#include "lab/page/section.h"

namespace palpate {

struct FitErrorRow {
  double weighting = 0.0;          ///< b [s/mm^2]
  double snr = 0.0;                ///< of the volumes without weighting
  double median = 0.0, p95 = 0.0;  ///< angle between true and fitted main direction [degrees]
  double seconds = 0.0;            ///< of a voxel's fit, on all threads asked for
};

struct FitErrors {
  std::vector<FitErrorRow> rows;  ///< by snr, then by weighting
  std::size_t gradients = 0, unweighted = 0, tensors = 0;
  double own_weighting = 0.0;  ///< the largest of the table [s/mm^2]
  bool made_up = false;        ///< the table is not of a file
};

/// One unweighted volume and `count` directions spread over the half sphere by the golden angle, b 1000
/// s/mm^2: for data without gradients.
[[nodiscard]] GradientTable spread_gradients(int count);

/// @pre gradient_problem(table) is empty. @param threads as FitOptions::threads. @throws Cancelled.
[[nodiscard]] FitErrors run_fit_errors(const GradientTable& table, Effort effort, int threads,
                                       Progress* progress);

[[nodiscard]] ReportSection fit_errors_section(const FitErrors& errors);
/// That errors are proportional to noise where it is small.
[[nodiscard]] std::vector<StabilityCase> fit_error_cases(const FitErrors& errors);

}  // namespace palpate
