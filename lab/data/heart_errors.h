/// What mesh and step cost of a heart: volume, layers, fibres, angles and lines of the built-in ventricle
/// against its formulas, and lines on the heart at hand against the finest step.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/analytic/ventricle.h"
#include "common/trace/layer_fibre.h"
#include "lab/data/stability.h"
#include "lab/data/sweep.h"
#include "lab/page/section.h"

namespace palpate {

/// The ventricle at one resolution.
struct HeartErrorRow {
  VentricleCells cells;
  std::size_t tetrahedra = 0;
  double volume = 0.0;           ///< of the mesh, off by this part of the exact one
  double potential = 0.0;        ///< depth by Laplace's equation, root mean square over points off the apex
  double potential_worst = 0.0;  ///< the largest, at the apex, where cells are wedges
  double fibre = 0.0;            ///< angle of the interpolated fibre, root mean square over places [degrees]
  double helix = 0.0;            ///< the same of the helix angle (Streeter)
  double helix_worst = 0.0;      ///< [degrees]
  double seconds = 0.0;          ///< mesh, index, fibres and layers that are given
  double seconds_layer = 0.0;    ///< Laplace's equation on top of that
};

/// From coarse to fine, the default resolution among them. @throws Cancelled.
[[nodiscard]] std::vector<HeartErrorRow> run_heart_errors(Effort effort, int threads, Progress* progress);

/// Fibre lines of one step.
struct FibreLineRow {
  double step = 0.0;    ///< h [diagonals]
  double median = 0.0;  ///< distance of ends from those of the finest step [diagonals]
  double p95 = 0.0;
  double stated = 0.0;   ///< median of the error that lines state [diagonals]
  double seconds = 0.0;  ///< of all lines
};

struct FibreLineErrors {
  std::string subject;
  double depth = 0.0;   ///< of the layer
  double length = 0.0;  ///< [diagonals]
  std::size_t lines = 0;
  std::vector<FibreLineRow> rows;  ///< from long steps to short ones
  double mesh = 0.0;  ///< median distance of the finest lines from the exact curves [diagonals]; 0: not known
};

/// Lines forward from `seeds` on the layer of that depth; those that end on their way are left out.
/// @param exact whose fibres they are, where that is known. @throws Cancelled, Error (usage) as
/// trace_fibres().
[[nodiscard]] FibreLineErrors run_fibre_lines(const std::string& subject, const LayeredHeart& heart,
                                              double depth, const std::vector<Vec3>& seeds,
                                              const Ventricle* exact, Effort effort, int threads,
                                              Progress* progress);
/// The same of the built-in ventricle at its default resolution.
[[nodiscard]] FibreLineErrors run_ventricle_lines(Effort effort, int threads, Progress* progress);

[[nodiscard]] ReportSection heart_errors_section(const std::vector<HeartErrorRow>& rows);
[[nodiscard]] ReportSection fibre_lines_section(const std::vector<FibreLineErrors>& errors);
/// That volume, layers and angles converge at second order, and what is promised of the default resolution.
[[nodiscard]] std::vector<StabilityCase> heart_error_cases(const std::vector<HeartErrorRow>& rows,
                                                           const FibreLineErrors& ventricle);

}  // namespace palpate
